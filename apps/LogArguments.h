#pragma once

#include <limits>
#include <string>

#include "CommandLine.h"
#include "scanTimesOf.h"

namespace taut
{
/** The options of every program that reads a rawlog: rig, sensors, part of the time. */
class LogArguments
{
 public:
    /** Adds them to the command line, which must be parsed before any of the following is asked. */
    explicit LogArguments(TCLAP::CmdLine& cmd)
        : rig_(
              "r", "rig", "Rig file: poses, noise and clocks of the sensors, over those in the log",
              false, "", "RIG.yaml", cmd),
          lidar_(
              "", "lidar",
              "Sensor label of the LiDAR, a regular expression (default: the only one)", false, "",
              "REGEX", cmd),
          imu_(
              "", "imu", "Sensor label of the IMU, a regular expression (default: the only one)",
              false, "", "REGEX", cmd),
          from_(
              "", "from-time", "Leave out what is earlier: seconds since the start of the log",
              false, 0, "SECONDS", cmd),
          to_("", "to-time", "End there: seconds since the start of the log", false,
              std::numeric_limits<double>::infinity(), "SECONDS", cmd),
          times_(
              "", "scan-times",
              "Scans without times of their points: azimuth tells them, or none (default auto: the "
              "azimuth of a sensor that turns, unless the scans are undistorted already)",
              false, "auto", "auto|azimuth|none", cmd)
    {
    }

    const std::string& rig() { return rig_.getValue(); }
    const std::string& lidarLabel() { return lidar_.getValue(); }
    const std::string& imuLabel() { return imu_.getValue(); }
    ScanTimes scanTimes() { return scanTimesOf(times_.getValue()); }
    double fromTime() { return from_.getValue(); }
    /** Throws UsageError if the part of the time is none. */
    double toTime()
    {
        if (from_.getValue() < 0 || !(to_.getValue() > from_.getValue()))
            throw UsageError("--to-time must be later than --from-time, and neither negative");
        constexpr double kLongest = 1e9;  // [s], 30 years: stamps reach no further
        if (from_.getValue() > kLongest)
            throw UsageError("--from-time is more than the 1e9 s that a log can take");
        return to_.getValue();
    }

 private:
    TCLAP::ValueArg<std::string> rig_, lidar_, imu_;
    TCLAP::ValueArg<double> from_, to_;
    TCLAP::ValueArg<std::string> times_;
};
}  // namespace taut
