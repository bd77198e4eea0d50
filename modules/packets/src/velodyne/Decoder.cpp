#include "taut/packets/velodyne/Decoder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "PacketLayout.h"

namespace taut::velodyne
{
namespace
{
constexpr double kDegree = M_PI / 180;

std::string hex(unsigned value)
{
    char text[16];
    std::snprintf(text, sizeof text, "0x%02x", value);
    return text;
}

Calibration fromDegrees(std::initializer_list<double> elevations)
{
    Calibration calibration;
    for (const double e : elevations)
    {
        Laser laser;
        laser.elevation = e * kDegree;
        calibration.push_back(laser);
    }
    return calibration;
}

int azimuthBetween(const std::uint8_t* packet, int from, int to)
{
    return (blockAzimuth(packet, to) - blockAzimuth(packet, from) + kFullTurn) % kFullTurn;
}

// The median step, since a head that fires only within a sector leaps between two blocks.
double turningRate(const std::uint8_t* packet, const FiringPattern& pattern, int blocks_per_firing)
{
    std::vector<int> steps;
    for (int block = blocks_per_firing; block < kBlocks; block += blocks_per_firing)
        steps.push_back(azimuthBetween(packet, block - blocks_per_firing, block));
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle * kAzimuthUnit / pattern.blockPeriod();  // [deg/ns]
}

void checkBlocks(const std::uint8_t* packet)
{
    for (int block = 0; block < kBlocks; block++)
        if (const auto flag = read16(packet + blockAt(block)); flag != kBlockFlag)
            throw std::runtime_error(
                "a Velodyne block has the flag " + hex(flag) + " instead of 0xeeff");
}

Eigen::Vector3f toPoint(const Laser& laser, double range, double azimuth)
{
    const double r = range + laser.range_correction;
    const double a = azimuth - laser.azimuth_correction;
    const double ce = std::cos(laser.elevation), se = std::sin(laser.elevation);
    const double horizontal = r * ce - laser.vertical_offset * se;
    const double left = laser.horizontal_offset;
    return Eigen::Vector3d(
               horizontal * std::cos(a) + left * std::sin(a),
               -horizontal * std::sin(a) + left * std::cos(a), r * se + laser.vertical_offset * ce)
        .cast<float>();
}

// In a pair of dual-return blocks the second one repeats the first where there was one return only.
bool repeatsFirstOfPair(const std::uint8_t* packet, int block, int slot)
{
    const auto* second = packet + returnAt(block, slot);
    const auto* first = packet + returnAt(block - 1, slot);
    return read16(first) == read16(second);
}
}  // namespace

const FiringPattern& firingPattern(Model model)
{
    static const FiringPattern vlp16{16, 2, 2304, 55296};
    static const FiringPattern hdl32{32, 1, 1152, 46080};
    return model == Model::Vlp16 ? vlp16 : hdl32;
}

const Calibration& defaultCalibration(Model model)
{
    static const Calibration vlp16 =
        fromDegrees({-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15});
    static const Calibration hdl32 = fromDegrees(
        {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
         -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
         -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67});
    return model == Model::Vlp16 ? vlp16 : hdl32;
}

std::uint16_t blockAzimuth(const std::uint8_t* packet, int block)
{
    return read16(packet + blockAt(block) + 2);
}

PacketInfo packetInfo(const std::uint8_t* packet)
{
    const auto model = packet[kModelAt];
    const auto mode = packet[kModeAt];
    if (model != static_cast<std::uint8_t>(Model::Vlp16) &&
        model != static_cast<std::uint8_t>(Model::Hdl32))
        throw std::runtime_error(
            "Velodyne model " + hex(model) + " is not known (0x21 HDL-32E, 0x22 VLP-16)");
    if (mode < static_cast<std::uint8_t>(ReturnMode::Strongest) ||
        mode > static_cast<std::uint8_t>(ReturnMode::Dual))
        throw std::runtime_error(
            "Velodyne return mode " + hex(mode) +
            " is not known (0x37 strongest, 0x38 last, 0x39 dual)");
    return {read32(packet + kTimeAt), static_cast<Model>(model), static_cast<ReturnMode>(mode)};
}

PacketInfo decodePacket(
    const std::uint8_t* packet, const Calibration& calibration, std::vector<Return>& returns)
{
    const PacketInfo info = packetInfo(packet);
    const FiringPattern& pattern = firingPattern(info.model);
    if (calibration.size() != static_cast<std::size_t>(pattern.lasers))
        throw std::runtime_error(
            "the calibration has " + std::to_string(calibration.size()) + " lasers, the sensor " +
            std::to_string(pattern.lasers));
    checkBlocks(packet);

    const bool dual = info.mode == ReturnMode::Dual;
    const int blocks_per_firing = dual ? 2 : 1;
    const double rate = turningRate(packet, pattern, blocks_per_firing);
    for (int block = 0; block < kBlocks; block++)
    {
        const int firing = block / blocks_per_firing;
        const double block_azimuth = blockAzimuth(packet, block) * kAzimuthUnit;
        for (int slot = 0; slot < kReturnsPerBlock; slot++)
        {
            const auto* cell = packet + returnAt(block, slot);
            const auto range = read16(cell);
            if (range == 0 || (dual && block % 2 == 1 && repeatsFirstOfPair(packet, block, slot)))
                continue;
            const int laser = slot % pattern.lasers, sequence = slot / pattern.lasers;
            const double in_block =
                sequence * pattern.sequence_period + laser * pattern.laser_period;
            const double azimuth = std::fmod(block_azimuth + rate * in_block, 360);
            Return r;
            r.position = toPoint(calibration[laser], range * kRangeUnit, azimuth * kDegree);
            r.azimuth = static_cast<float>(azimuth);
            r.offset =
                static_cast<std::int32_t>(std::lround(firing * pattern.blockPeriod() + in_block));
            r.laser = static_cast<std::uint8_t>(laser);
            r.intensity = cell[2];
            r.block = static_cast<std::uint8_t>(block);
            returns.push_back(r);
        }
    }
    return info;
}

Duration PacketClock::sinceFirst(std::uint32_t microseconds)
{
    if (started_)
    {
        std::int64_t step = (static_cast<std::int64_t>(microseconds) - last_) % kHour;
        if (step < -kHour / 2) step += kHour;
        if (step > kHour / 2) step -= kHour;
        elapsed_ += step * 1000;
    }
    started_ = true;
    last_ = microseconds;
    return elapsed_;
}
}  // namespace taut::velodyne
