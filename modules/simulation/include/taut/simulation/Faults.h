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

/** Stamps that the computer gives when a measurement arrives, instead of the sensor. What came
 * later is never stamped earlier. */
struct HostStamps
{
    double jitter = 0;  //!< mean delay of the arrival, distributed exponentially [s]
    double step = 0;    //!< then the next poll takes it: the stamps are multiples of this [s]
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
    HostStamps imu_stamps, lidar_stamps;
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
    /** When the computer takes what was there at t; `before`: what it took last. */
    Time arrival(
        const HostStamps& stamps, Time t, std::optional<Time>& before, std::uint64_t stream,
        std::uint64_t index) const;

    FaultConfig config_;
    std::uint64_t seed_;
    std::optional<Time> last_sample_, last_scan_, sample_arrival_, scan_arrival_;
};
}  // namespace taut::simulation
