#pragma once

#include <optional>
#include <string>
#include <utility>

#include "taut/core/Beams.h"
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
    /** Elevation of the first and the last row of range images, the others evenly between [rad]. */
    std::optional<std::pair<double, double>> row_elevations;
    BeamCorrections beams;  //!< added to what it measures
};

/** Facts of the IMU that override the log's. */
struct ImuRig
{
    std::string label;  //!< regular expression of the sensor described; empty = any
    std::optional<Pose> T_vehicle_imu;
    double accel_scale = 1;  //!< factor to m/s^2: 9.80665 for values in g
    double gyro_scale = 1;   //!< factor to rad/s: 0.0174532925 for values in deg/s
    std::optional<ImuNoise> noise;
    /** Beyond its range a sample is an error of the transfer, and left out: 200 g and 20,000 deg/s
     * are the largest ranges of MEMS sensors (ADXL375, ADXRS649). */
    double max_accel = 200 * 9.80665;          //!< [m/s^2], after the scale
    double max_rate = 20'000 * 0.01745329252;  //!< [rad/s], after the scale
};

/** A sensor set: what the log does not say, or says wrongly. A part whose label does not match the
 * sensor in use is not applied. */
struct Rig
{
    LidarRig lidar;
    ImuRig imu;
};

/** Reads a rig file (YAML; config/rig-example.yaml shows every key). Throws ConfigError naming the
 * file and the key that is unknown or wrong. */
Rig loadRig(const std::string& path);

/** The same from text; `name` stands for the file in messages. */
Rig parseRig(const std::string& yaml_text, const std::string& name = "rig");
}  // namespace taut
