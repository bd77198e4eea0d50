#include "ImuUnitCheck.h"

#include <cmath>
#include <sstream>

namespace taut
{
namespace
{
constexpr Duration kWindow = 1'000'000'000;
constexpr double kFastestRate = 80;  // rad/s; gyros end at 35 (2000 deg/s) or 70 (4000 deg/s)

std::string number(double v)
{
    std::ostringstream s;
    s.precision(3);
    s << v;
    return s.str();
}

Vector3d meanAccel(const ImuSamples& samples, std::size_t begin, std::size_t end)
{
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = begin; i < end; i++) sum += samples[i].accel;
    return sum / static_cast<double>(end - begin);
}
}  // namespace

std::optional<std::string> ImuUnitCheck::add(const ImuSample& sample)
{
    if (!rate_reported_ && sample.gyro.norm() > kFastestRate)
    {
        rate_reported_ = true;
        return "a rate of " + number(sample.gyro.norm()) +
               " cannot be in rad/s; if the log has deg/s, set gyro_scale: 0.0174532925 in the rig "
               "file";
    }
    if (judged_) return {};
    if (first_second_.empty() || sample.t - first_second_.front().t < kWindow)
    {
        first_second_.push_back(sample);
        return {};
    }
    judged_ = true;
    auto verdict = judgeFirstSecond();
    first_second_ = {};
    return verdict;
}

std::optional<std::string> ImuUnitCheck::judgeFirstSecond() const
{
    const std::size_t n = first_second_.size();
    if (n < 10) return {};
    double force = 0;
    Vector3d rate = Vector3d::Zero();
    for (const auto& s : first_second_)
    {
        force += s.accel.norm() / static_cast<double>(n);
        rate += s.gyro / static_cast<double>(n);
    }
    if (force > 0.3 && force < 3)
        return "the mean specific force of the first second is " + number(force) +
               ", not 9.8 m/s^2; if the log has g units, set accel_scale: 9.80665 in the rig file";
    if (force > 500 && force < 1500)
        return "the mean specific force of the first second is " + number(force) +
               ", not 9.8 m/s^2; if the log has milli-g, set accel_scale: 0.00980665 in the rig "
               "file";
    if (force < 5 || force > 20)
        return "the mean specific force of the first second is " + number(force) +
               ", not near 9.8 m/s^2: set accel_scale in the rig file";

    if (std::abs(force - 9.81) > 0.4) return {};  // not at rest: gravity is not what is seen

    // What the gyro says that gravity turned from the middle of the first to that of the last
    // third, and what the accelerometer saw of it. A turn around the vertical is invisible to both.
    const Vector3d before = meanAccel(first_second_, 0, n / 3).normalized();
    const Vector3d after = meanAccel(first_second_, n - n / 3, n).normalized();
    const double duration = toSeconds(first_second_.back().t - first_second_.front().t) * 2.0 / 3.0;
    const double seen = before.cross(after).norm();
    const double claimed = (rate - before * before.dot(rate)).norm() * duration;
    if (claimed > 0.15 && claimed < 1.5 && seen < 0.2 * claimed)
        return "in the first second the gyro claims a turn of " + number(claimed) +
               " rad across the vertical, the accelerometer saw " + number(seen) +
               " rad; if the log has deg/s, set gyro_scale: 0.0174532925 in the rig file";
    return {};
}
}  // namespace taut
