#include "taut/rawlog/RawlogWriter.h"

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "GzOutput.h"
#include "MrptConversion.h"

namespace taut
{
using namespace mrpt::obs;

struct RawlogWriter::Impl
{
    Impl(const std::string& path, const RawlogWriterConfig& c) : config(c), output(path) {}

    CObservationVelodyneScan lidarObservation(
        Time stamp, const std::string& label, const Pose& T_imu_lidar) const
    {
        CObservationVelodyneScan o;
        o.timestamp = o.originalReceivedTimestamp = toMrptTime(stamp);
        o.sensorLabel = label.empty() ? config.lidar_label : label;
        o.sensorPose = toMrptPose(config.T_vehicle_imu * T_imu_lidar);
        return o;
    }

    void write(const CObservation& observation)
    {
        buffer.clear();
        auto archive = mrpt::serialization::archiveFrom(buffer);
        archive << observation;
        output.write(buffer);
    }

    RawlogWriterConfig config;
    GzOutput output;
    std::vector<std::uint8_t> buffer;
};

RawlogWriter::RawlogWriter(const std::string& path, const RawlogWriterConfig& config)
    : impl_(std::make_unique<Impl>(path, config))
{
}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const ImuSample& sample)
{
    CObservationIMU o;
    o.timestamp = toMrptTime(sample.t);
    o.sensorLabel = impl_->config.imu_label;
    o.sensorPose = toMrptPose(impl_->config.T_vehicle_imu);
    o.set(IMU_X_ACC, sample.accel.x());
    o.set(IMU_Y_ACC, sample.accel.y());
    o.set(IMU_Z_ACC, sample.accel.z());
    o.set(IMU_WX, sample.gyro.x());
    o.set(IMU_WY, sample.gyro.y());
    o.set(IMU_WZ, sample.gyro.z());
    impl_->write(o);
}

void RawlogWriter::write(const Scan& scan)
{
    auto o = impl_->lidarObservation(scan.stamp, scan.sensor_label, scan.T_imu_lidar);
    auto& cloud = o.point_cloud;
    for (const auto& point : scan.points)
    {
        cloud.x.push_back(point.position.x());
        cloud.y.push_back(point.position.y());
        cloud.z.push_back(point.position.z());
        cloud.intensity.push_back(
            static_cast<std::uint8_t>(std::lround(std::clamp(point.intensity, 0.0f, 255.0f))));
        cloud.timestamp.push_back(toMrptTime(scan.timeOf(point)));
        cloud.laser_id.push_back(static_cast<std::int16_t>(point.ring));
    }
    impl_->write(o);
}

void RawlogWriter::write(const PacketScan& scan)
{
    auto o = impl_->lidarObservation(scan.stamp, scan.sensor_label, scan.T_imu_lidar);
    using RawPacket = CObservationVelodyneScan::TVelodyneRawPacket;
    static_assert(sizeof(RawPacket) == velodyne::kPacketBytes);
    static_assert(std::is_trivially_copyable_v<RawPacket>);
    o.scan_packets.resize(scan.packets.size());
    for (std::size_t i = 0; i < scan.packets.size(); i++)
        std::memcpy(&o.scan_packets[i], scan.packets[i].data(), velodyne::kPacketBytes);
    impl_->write(o);
}

void RawlogWriter::close()
{
    impl_->output.close();
}
}  // namespace taut
