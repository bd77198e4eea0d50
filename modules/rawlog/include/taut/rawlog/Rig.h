#pragma once

#include <optional>
#include <string>

#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"

namespace taut
{
/** Facts of the LiDAR that override the log's. */
struct LidarRig
{
    std::string label;  //!< regular expression of the sensor described; empty = any
    std::optional<Pose> T_vehicle_lidar;
    double clock_offset = 0;  //!< [s] added to the LiDAR's stamps to get the IMU's clock
};

/** Facts of the IMU that override the log's. */
struct ImuRig
{
    std::string label;  //!< regular expression of the sensor described; empty = any
    std::optional<Pose> T_vehicle_imu;
    double accel_scale = 1;  //!< factor to m/s^2: 9.80665 for values in g
    double gyro_scale = 1;   //!< factor to rad/s: 0.0174532925 for values in deg/s
    std::optional<ImuNoise> noise;
};

/** A sensor set, as a rig file describes it. */
struct Rig
{
    LidarRig lidar;
    ImuRig imu;
};
}  // namespace taut
