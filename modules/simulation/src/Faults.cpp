#include "taut/simulation/Faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
constexpr std::uint64_t kSampleStream = 20, kScanStream = 21;
constexpr std::uint64_t kSampleArrivals = 22, kScanArrivals = 23;
constexpr Duration kTick = 100;  // of the stamps in rawlogs [ns]
}  // namespace

Time Faults::clock(Time t) const
{
    return t >= fromSeconds(config_.jump_at) ? t + fromSeconds(config_.jump_by) : t;
}

bool Faults::within(const Window& window, Time begin, Time end)
{
    return window.duration > 0 && end >= fromSeconds(window.at) &&
           begin < fromSeconds(window.at + window.duration);
}

Time Faults::arrival(
    const HostStamps& stamps, Time t, std::optional<Time>& before, std::uint64_t stream,
    std::uint64_t index) const
{
    if (stamps.jitter <= 0 && stamps.step <= 0) return t;
    Random random(seed_, stream, index);
    Duration delay = fromSeconds(-stamps.jitter * std::log(1 - random.uniform()));
    delay -= delay % kTick;
    t = std::max(t + delay, before.value_or(t));
    const Duration step = fromSeconds(stamps.step);
    if (step > 0) t += (step - t % step) % step;
    before = t;
    return t;
}

bool Faults::spoil(ImuSample& sample, std::uint64_t index)
{
    if (within(config_.imu_gap, sample.t, sample.t)) return false;
    sample.t =
        clock(arrival(config_.imu_stamps, sample.t, sample_arrival_, kSampleArrivals, index));
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
    scan.stamp =
        clock(arrival(config_.lidar_stamps, scan.stamp, scan_arrival_, kScanArrivals, index));
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
    const auto stamps = [&section](const char* name, HostStamps& h)
    {
        ConfigSection& s = section.section(name);
        s.key("jitter", h.jitter, {0, 10}, "s, mean delay of the arrival; 0 = none");
        s.key("step", h.step, {0, 10}, "s between polls, whose times the stamps are; 0 = none");
    };
    stamps("imu_stamps", config.imu_stamps);
    stamps("lidar_stamps", config.lidar_stamps);
}
}  // namespace taut::simulation
