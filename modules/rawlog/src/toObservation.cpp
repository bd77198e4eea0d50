#include "taut/rawlog/toObservation.h"

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "MrptConversion.h"

namespace taut
{
using namespace mrpt::obs;

namespace
{
CObservationVelodyneScan::Ptr lidarObservation(
    Time stamp, const std::string& label, const Pose& T_imu_lidar, const RawlogWriterConfig& config)
{
    auto o = CObservationVelodyneScan::Create();
    o->timestamp = o->originalReceivedTimestamp = toMrptTime(stamp);
    o->sensorLabel = label.empty() ? config.lidar_label : label;
    o->sensorPose = toMrptPose(config.T_vehicle_imu * T_imu_lidar);
    return o;
}
}  // namespace

CObservation::Ptr toObservation(const ImuSample& sample, const RawlogWriterConfig& config)
{
    auto o = CObservationIMU::Create();
    o->timestamp = toMrptTime(sample.t);
    o->sensorLabel = config.imu_label;
    o->sensorPose = toMrptPose(config.T_vehicle_imu);
    o->set(IMU_X_ACC, sample.accel.x());
    o->set(IMU_Y_ACC, sample.accel.y());
    o->set(IMU_Z_ACC, sample.accel.z());
    o->set(IMU_WX, sample.gyro.x());
    o->set(IMU_WY, sample.gyro.y());
    o->set(IMU_WZ, sample.gyro.z());
    return o;
}

CObservation::Ptr toObservation(const Scan& scan, const RawlogWriterConfig& config)
{
    auto o = lidarObservation(scan.stamp, scan.sensor_label, scan.T_imu_lidar, config);
    auto& cloud = o->point_cloud;
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
    return o;
}

CObservation::Ptr toObservation(const PacketScan& scan, const RawlogWriterConfig& config)
{
    auto o = lidarObservation(scan.stamp, scan.sensor_label, scan.T_imu_lidar, config);
    using RawPacket = CObservationVelodyneScan::TVelodyneRawPacket;
    static_assert(sizeof(RawPacket) == velodyne::kPacketBytes);
    static_assert(std::is_trivially_copyable_v<RawPacket>);
    o->scan_packets.resize(scan.packets.size());
    for (std::size_t i = 0; i < scan.packets.size(); i++)
        std::memcpy(&o->scan_packets[i], scan.packets[i].data(), velodyne::kPacketBytes);
    return o;
}
}  // namespace taut
