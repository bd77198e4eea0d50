#include "ImuUnits.h"

#include <algorithm>
#include <cstdio>

namespace taut::bag
{
namespace
{
constexpr double kGravity = 9.80665;  // m/s^2: what "1 g" means
constexpr double kFastestRate = 80;   // rad/s; gyros end at 35 (2000 deg/s) or 70 (4000 deg/s)
constexpr std::size_t kFewest = 10;   // readings that tell something

std::string line(const char* format, double value, std::size_t count)
{
    char text[200];
    std::snprintf(text, sizeof text, format, value, count);
    return text;
}
}  // namespace

void ImuUnits::learn(const ImuSamples& samples, const WarningSink& warn)
{
    if (samples.size() < kFewest) return;
    double force = 0, fastest = 0;
    for (const ImuSample& sample : samples)
    {
        force += sample.accel.norm() / static_cast<double>(samples.size());
        fastest = std::max(fastest, sample.gyro.norm());
    }
    const std::size_t n = samples.size();
    if (force > 5 && force < 20)
        findings_.push_back(
            line("specific force: in m/s^2, for its mean is %.4g over %zu readings", force, n));
    else if (force > 0.3 && force < 3)
    {
        accel_scale_ = kGravity;
        findings_.push_back(line(
            "specific force: in g, for its mean is %.4g over %zu readings; converted", force, n));
    }
    else if (force > 500 && force < 1500)
    {
        accel_scale_ = kGravity / 1000;
        findings_.push_back(line(
            "specific force: in milli-g, for its mean is %.4g over %zu readings; converted", force,
            n));
    }
    else if (warn)
        warn(
            {samples.front().t, "imu_units",
             line(
                 "the mean specific force is %.4g over %zu readings, neither near 9.8 m/s^2 nor "
                 "near 1 g: used as it is; set accel_scale in the rig file",
                 force, n)});
    if (fastest > kFastestRate && warn)
        warn(
            {samples.front().t, "imu_units",
             line(
                 "a rate of %.4g among %zu readings cannot be in rad/s: used as it is; if it has "
                 "deg/s, set gyro_scale: 0.0174532925 in the rig file",
                 fastest, n)});
}
}  // namespace taut::bag
