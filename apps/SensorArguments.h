#pragma once

#include <string>

#include "CommandLine.h"
#include "scanTimesOf.h"

namespace taut
{
/** The options that say which sensors are used, and what of them the log does not tell. */
class SensorArguments
{
 public:
    /** Adds them to the command line, which must be parsed before any of the following is asked. */
    explicit SensorArguments(TCLAP::CmdLine& cmd)
        : rig_(
              "r", "rig", "Rig file: poses, noise and clocks of the sensors, over those in the log",
              false, "", "RIG.yaml", cmd),
          lidar_(
              "", "lidar",
              "Rawlogs: sensor label of the LiDAR, a regular expression (default: the only one)",
              false, "", "REGEX", cmd),
          imu_(
              "", "imu",
              "Rawlogs: sensor label of the IMU, a regular expression (default: the only one)",
              false, "", "REGEX", cmd),
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

 protected:
    bool choosesByLabel() const { return lidar_.isSet() || imu_.isSet(); }

 private:
    TCLAP::ValueArg<std::string> rig_, lidar_, imu_, times_;
};
}  // namespace taut
