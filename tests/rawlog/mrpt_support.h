#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
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
}  // namespace taut::test
