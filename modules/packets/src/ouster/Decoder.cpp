#include "taut/packets/ouster/Decoder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include "../littleEndian.h"
#include "PacketLayout.h"

namespace taut::ouster
{
namespace
{
constexpr double kDegree = M_PI / 180;
constexpr Duration kLongestFrame = 2'000'000'000;    // offsets fit 32 bits
constexpr Time kLatest = 4'000'000'000'000'000'000;  // the year 2096: differences do not overflow
constexpr double kPaceTolerance = 0.25;
constexpr int kWrongPaces = 32;  // in a row: a clock that is set once is no other lidar mode

std::uint64_t serialOf(const std::uint8_t* packet, const PacketLayout& layout)
{
    return readLittle<std::uint32_t>(packet + layout.serial_at) |
           static_cast<std::uint64_t>(packet[layout.serial_at + 4]) << 32;
}

bool isValid(const std::uint8_t* column, const PacketLayout& layout, std::size_t column_bytes)
{
    const std::uint8_t* status = layout.column_footer > 0
                                     ? column + column_bytes - layout.column_footer
                                     : column + kStatusAt;
    return (*status & 1) != 0;
}
}  // namespace

std::size_t lidarPacketBytes(const SensorInfo& info)
{
    const PacketLayout layout = layoutOf(info.profile);
    return layout.header + layout.footer +
           static_cast<std::size_t>(info.columns_per_packet) *
               layout.columnBytes(info.pixels_per_column);
}

std::string misfit(const SensorInfo& info, const std::uint8_t* packet, std::size_t bytes)
{
    if (bytes != lidarPacketBytes(info))
        return "a lidar packet has " + std::to_string(bytes) +
               " bytes where the description says " + std::to_string(lidarPacketBytes(info)) +
               ": it is of another sensor or setting";
    if (info.profile == Profile::Legacy || info.serial == 0) return "";
    const auto serial = serialOf(packet, layoutOf(info.profile));
    if (serial == info.serial) return "";
    return "a packet is of the sensor " + std::to_string(serial) + ", the description of " +
           std::to_string(info.serial);
}

ImuSample decodeImu(const std::uint8_t* packet)
{
    constexpr std::size_t kGyroTimeAt = 16, kAccelAt = 24, kGyroAt = 36;
    ImuSample sample;
    sample.t = readLittle<std::int64_t>(packet + kGyroTimeAt);
    if (sample.t < 0 || sample.t > kLatest)
        throw std::runtime_error("an IMU packet has an impossible time");
    for (int i = 0; i < 3; i++)
    {
        const auto axis = static_cast<std::size_t>(i) * sizeof(float);
        sample.accel[i] = readLittle<float>(packet + kAccelAt + axis) * kStandardGravity;
        sample.gyro[i] = readLittle<float>(packet + kGyroAt + axis) * kDegree;
    }
    return sample;
}

FrameAssembler::FrameAssembler(const SensorInfo& info) : info_(info)
{
    for (int i = 0; i < info.pixels_per_column; i++)
        beams_.push_back(
            {-info.beam_azimuths[i], std::cos(info.beam_altitudes[i]),
             std::sin(info.beam_altitudes[i])});
}

std::optional<Frame> FrameAssembler::add(const std::uint8_t* packet, std::size_t bytes)
{
    if (const std::string cause = misfit(info_, packet, bytes); !cause.empty())
        throw DescriptionError(cause);
    packet_time_.reset();
    const PacketLayout layout = layoutOf(info_.profile);
    const std::size_t column_bytes = layout.columnBytes(info_.pixels_per_column);
    const int id = readLittle<std::uint16_t>(packet + layout.frame_at);
    std::optional<Frame> complete;
    if (started_ && id != frame_.id)
    {
        // Ids run on from 65535 to 0.
        if (static_cast<std::int16_t>(id - frame_.id) < 0)
        {
            late_ += static_cast<std::size_t>(info_.columns_per_packet);
            return {};
        }
        complete = finish();
    }
    started_ = true;
    frame_.id = id;
    for (int i = 0; i < info_.columns_per_packet; i++)
    {
        const std::uint8_t* column =
            packet + layout.header + static_cast<std::size_t>(i) * column_bytes;
        if (isValid(column, layout, column_bytes)) addColumn(column);
    }
    return complete;
}

void FrameAssembler::addColumn(const std::uint8_t* column)
{
    const auto t = readLittle<std::int64_t>(column + kColumnTimeAt);
    const int measurement = readLittle<std::uint16_t>(column + kMeasurementAt);
    if (t < 0 || t > kLatest) throw std::runtime_error("a column has an impossible time");
    checkPace(measurement, t);
    Scan& scan = frame_.scan;
    if (frame_.columns == 0) scan.stamp = scan.end = t;
    if (std::abs(t - scan.stamp) > kLongestFrame)
        throw std::runtime_error("the times of a frame's columns differ by more than 2 s");
    packet_time_ = t;
    frame_.columns++;
    scan.end = std::max(scan.end, t);
    addPoints(column, measurement, t);
}

void FrameAssembler::addPoints(const std::uint8_t* column, int measurement, Time t)
{
    const PacketLayout layout = layoutOf(info_.profile);
    Scan& scan = frame_.scan;
    const double encoder =
        2 * M_PI * (1 - static_cast<double>(measurement) / info_.columns_per_frame);
    const double ce = std::cos(encoder), se = std::sin(encoder);
    const double to_beam = info_.beam_origin.norm();
    const Vector3d origin(
        info_.beam_origin.x() * ce, info_.beam_origin.x() * se, info_.beam_origin.z());
    for (int i = 0; i < info_.pixels_per_column; i++)
    {
        const std::uint8_t* pixel =
            column + layout.column_header + static_cast<std::size_t>(i) * layout.pixel;
        const auto range = readLittle<std::uint32_t>(pixel) & layout.range_mask;
        if (range == 0) continue;
        const Beam& beam = beams_[i];
        const double a = encoder + beam.azimuth;
        const Vector3d direction(
            std::cos(a) * beam.cos_altitude, std::sin(a) * beam.cos_altitude, beam.sin_altitude);
        LidarPoint point;
        point.position = (origin + (range * layout.range_unit - to_beam) * direction).cast<float>();
        const auto* reflectivity = pixel + layout.reflectivity_at;
        point.intensity =
            layout.wide_reflectivity ? readLittle<std::uint16_t>(reflectivity) : *reflectivity;
        point.offset = static_cast<std::int32_t>(t - scan.stamp);
        point.ring = static_cast<std::uint16_t>(i);
        scan.points.push_back(point);
    }
}

/* A description saved in another lidar mode would bend the world. */
void FrameAssembler::checkPace(int measurement, Time t)
{
    if (measurement >= info_.columns_per_frame)
        throw DescriptionError(
            "a packet has column " + std::to_string(measurement) + " of a turn, the description " +
            std::to_string(info_.columns_per_frame) + " columns: it is of another lidar mode");
    const bool follows = last_measurement_ >= 0 && measurement == last_measurement_ + 1;
    const double turn = toSeconds(t - last_time_) * info_.columns_per_frame;
    last_measurement_ = measurement;
    last_time_ = t;
    if (!follows || info_.frame_rate <= 0) return;
    const bool right = std::abs(turn * info_.frame_rate - 1) < kPaceTolerance;
    wrong_paces_ = right ? 0 : wrong_paces_ + 1;
    if (wrong_paces_ < kWrongPaces) return;
    throw DescriptionError(
        "a turn takes " + std::to_string(turn) + " s by the packets and " +
        std::to_string(1 / info_.frame_rate) +
        " s by the description: it is of another lidar mode");
}

std::optional<Frame> FrameAssembler::finish()
{
    if (frame_.columns == 0)
    {
        frame_ = {};
        return {};
    }
    // Packets may be captured in another order than they were sent.
    std::int32_t first = 0;
    for (const LidarPoint& point : frame_.scan.points) first = std::min(first, point.offset);
    if (first < 0)
        for (LidarPoint& point : frame_.scan.points) point.offset -= first;
    frame_.scan.stamp += first;
    frame_.scan.rings = info_.pixels_per_column;
    frame_.scan.T_imu_lidar = info_.T_imu_lidar();
    return std::exchange(frame_, {});
}
}  // namespace taut::ouster
