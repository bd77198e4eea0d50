#include "taut/simulation/Faults.h"

#include <limits>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
constexpr std::uint64_t kSampleStream = 20, kScanStream = 21;
}

Time Faults::clock(Time t) const
{
    return t >= fromSeconds(config_.jump_at) ? t + fromSeconds(config_.jump_by) : t;
}

bool Faults::within(const Window& window, Time begin, Time end)
{
    return window.duration > 0 && end >= fromSeconds(window.at) &&
           begin < fromSeconds(window.at + window.duration);
}

bool Faults::spoil(ImuSample& sample, std::uint64_t index)
{
    if (within(config_.imu_gap, sample.t, sample.t)) return false;
    sample.t = clock(sample.t);
    Random random(seed_, kSampleStream, index);
    if (last_sample_ && random.uniform() < config_.repeated_stamps) sample.t = *last_sample_;
    last_sample_ = sample.t;
    return true;
}

bool Faults::spoil(SimulatedScan& simulated, std::uint64_t index)
{
    Scan& scan = simulated.scan;
    if (within(config_.lidar_gap, scan.stamp, scan.end)) return false;
    const Duration length = scan.end - scan.stamp;
    scan.stamp = clock(scan.stamp);
    Random random(seed_, kScanStream, index);
    if (last_scan_ && random.uniform() < config_.repeated_stamps) scan.stamp = *last_scan_;
    scan.end = scan.stamp + length;
    last_scan_ = scan.stamp;
    for (std::size_t i = 0; i < scan.points.size(); i++)
    {
        if (random.uniform() >= config_.nan_points) continue;
        scan.points[i].position.setConstant(std::numeric_limits<float>::quiet_NaN());
        simulated.truth[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    return true;
}

void declare(ConfigSection& section, FaultConfig& config)
{
    const auto window = [&section](const char* name, Window& w)
    {
        ConfigSection& s = section.section(name);
        s.key("at", w.at, kNotNegative, "s since the start");
        s.key("duration", w.duration, kNotNegative, "s; 0 = none");
    };
    window("imu_gap", config.imu_gap);
    window("lidar_gap", config.lidar_gap);
    section.key("nan_points", config.nan_points, {0, 1}, "part of the points that are not finite");
    section.key(
        "repeated_stamps", config.repeated_stamps, {0, 1},
        "part of samples and scans with the stamp of the one before");
    ConfigSection& jump = section.section("time_jump");
    jump.key("at", config.jump_at, kNotNegative, "s since the start");
    jump.key("by", config.jump_by, {-1e6, 1e6}, "s, forward or back, of all sensors; 0 = never");
}
}  // namespace taut::simulation
