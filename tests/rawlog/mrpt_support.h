#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "rawlog_support.h"

namespace taut::test
{
using Bytes = std::vector<std::uint8_t>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

inline mrpt::Clock::time_point mrptTime(Time t)
{
    return mrpt::Clock::time_point(mrpt::Clock::duration(t / 100 + 116444736000000000));
}

/** The objects of a rawlog, uncompressed. */
class LogBytes
{
 public:
    LogBytes& add(const mrpt::serialization::CSerializable& object)
    {
        auto archive = mrpt::serialization::archiveFrom(bytes_);
        archive << object;
        ends_.push_back(bytes_.size());
        return *this;
    }
    const Bytes& bytes() const { return bytes_; }
    Bytes& bytes() { return bytes_; }
    const std::vector<std::size_t>& ends() const { return ends_; }  //!< of the objects

 private:
    Bytes bytes_;
    std::vector<std::size_t> ends_;
};

inline void writeFile(const std::string& path, const Bytes& bytes)
{
    std::ofstream(path, std::ios::binary)
        .write(
            reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

inline Bytes readFile(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

inline mrpt::obs::CObservationIMU mrptImu(
    Time t, const std::string& label = "IMU", const ImuSample& values = restingImu(0))
{
    using namespace mrpt::obs;
    CObservationIMU o;
    o.timestamp = mrptTime(t);
    o.sensorLabel = label;
    o.set(IMU_X_ACC, values.accel.x());
    o.set(IMU_Y_ACC, values.accel.y());
    o.set(IMU_Z_ACC, values.accel.z());
    o.set(IMU_WX, values.gyro.x());
    o.set(IMU_WY, values.gyro.y());
    o.set(IMU_WZ, values.gyro.z());
    return o;
}

inline mrpt::obs::CObservationVelodyneScan mrptScan(Time t, const std::string& label = "LIDAR")
{
    mrpt::obs::CObservationVelodyneScan o;
    o.timestamp = mrptTime(t);
    o.sensorLabel = label;
    for (const auto& point : smallScan(t).points)
    {
        o.point_cloud.x.push_back(point.position.x());
        o.point_cloud.y.push_back(point.position.y());
        o.point_cloud.z.push_back(point.position.z());
        o.point_cloud.intensity.push_back(static_cast<std::uint8_t>(point.intensity));
        o.point_cloud.timestamp.push_back(mrptTime(t + point.offset));
        o.point_cloud.laser_id.push_back(static_cast<std::int16_t>(point.ring));
    }
    return o;
}

/** Every vector of the class holds something. */
inline mrpt::obs::CObservationVelodyneScan fullVelodyneScan(Time t)
{
    auto o = mrptScan(t);
    o.scan_packets.resize(2);
    o.calibration.laser_corrections.resize(3);
    o.point_cloud.azimuth.resize(7);
    o.point_cloud.pointsForLaserID = {{1}, {}, {2, 3}};
    return o;
}

inline mrpt::obs::CObservationRotatingScan rotatingScan(Time t)
{
    mrpt::obs::CObservationRotatingScan o;
    o.timestamp = mrptTime(t);
    o.sensorLabel = "LIDAR";
    o.lidarModel = "HDL-32E";
    o.rowCount = 32;
    o.columnCount = 6;
    o.azimuthSpan = -6;
    o.sweepDuration = 0.1;
    o.rangeResolution = 0.01;
    o.rangeImage.resize(32, 6);
    o.rangeImage.fill(500);
    o.intensityImage.resize(32, 6);
    o.intensityImage.fill(9);
    o.rangeOtherLayers["STRONGEST"] = o.rangeImage;
    o.rangeOtherLayers["LAST"] = o.rangeImage;
    return o;
}
}  // namespace taut::test
