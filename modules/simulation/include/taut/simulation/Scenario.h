#pragma once

#include <string>
#include <vector>

#include "taut/core/Config.h"
#include "taut/simulation/Faults.h"
#include "taut/simulation/ImuModel.h"
#include "taut/simulation/Lidar.h"
#include "taut/simulation/MotionGenerator.h"
#include "taut/simulation/World.h"

namespace taut::simulation
{
/** All that a simulation depends on: the same scenario gives the same bits. */
struct Scenario
{
    double duration = 40;  //!< of the recording, with the rest [s]
    double rest = 10;      //!< at its start [s]; 0: in motion from the first moment on
    int seed = 1;
    int start_time = 1700000000;  //!< of the recording [s since the UNIX epoch]
    WorldConfig world;
    MotionConfig motion;
    LidarConfig lidar;
    ImuConfig imu;
    FaultConfig faults;
    WeatherConfig weather;
    double clearance =
        0.25;  //!< of the body from every surface: a motion that comes closer is refused [m]
};

/** Reads a scenario. Throws ConfigError that names the key on anything unknown or out of range. */
Scenario readScenario(ConfigSection& section);

/** The YAML file with `key=value` settings put over it (dots name sections: imu.rate=100). Throws
 * std::runtime_error if the file cannot be read, ConfigError on a setting that is none. */
ConfigSection loadScenarioFile(const std::string& path, const std::vector<std::string>& settings);
}  // namespace taut::simulation
