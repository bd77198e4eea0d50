#pragma once

#include <cstdint>
#include <optional>

#include "taut/core/Config.h"
#include "taut/core/Imu.h"
#include "taut/simulation/Lidar.h"

namespace taut::simulation
{
/** A span of time, since the start of the simulation. */
struct Window
{
    double at = 0;        //!< [s]
    double duration = 0;  //!< [s]; 0 = none
};

/** What goes wrong with a recording. */
struct FaultConfig
{
    Window imu_gap, lidar_gap;  //!< nothing is recorded
    double nan_points = 0;      //!< part of the points without finite coordinates
    double repeated_stamps =
        0;               //!< part of samples and scans that carry the stamp of the one before
    double jump_at = 0;  //!< the clock of all sensors is put on... [s]
    double jump_by = 0;  //!< ...or back by so much [s]; 0 = never
};

void declare(ConfigSection& section, FaultConfig& config);

/** Spoils a recording. Samples and scans are given in the order of time. */
class Faults
{
 public:
    Faults(const FaultConfig& config, std::uint64_t seed) : config_(config), seed_(seed) {}

    /** True time to the sensors' clock. */
    Time clock(Time t) const;

    /** False: the sample never comes. `index` of the sample names the random numbers. */
    bool spoil(ImuSample& sample, std::uint64_t index);
    /** False: the scan never comes. */
    bool spoil(SimulatedScan& scan, std::uint64_t index);

 private:
    static bool within(const Window& window, Time begin, Time end);

    FaultConfig config_;
    std::uint64_t seed_;
    std::optional<Time> last_sample_, last_scan_;
};
}  // namespace taut::simulation
