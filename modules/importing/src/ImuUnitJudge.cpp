#include "ImuUnitJudge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace taut
{
namespace
{
constexpr Duration kWindow = 1'000'000'000;
constexpr std::size_t kFewest = 10, kMost = 10'000;  // samples of a window
constexpr double kStandardGravity = 9.80665;         // m/s^2: what "1 g" means
constexpr double kDegree = M_PI / 180;
constexpr std::size_t kNoOutliers = 5;  // samples that are too fast by mistake are fewer
constexpr double kRestTolerance = 0.5;  // m/s^2 about gravity: little else is felt
constexpr double kClear = 3;            // so much better one unit must explain the turn, and
constexpr double kTurn = 0.05;          // rad, this wrong the other must be

std::string text(const char* format, double value)
{
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

Vector3d meanAccel(const ImuSamples& samples, std::size_t begin, std::size_t end)
{
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = begin; i < end; i++) sum += samples[i].accel;
    return sum / static_cast<double>(end - begin);
}

/** Angle between `after` and where the rates from sample `begin` to `end` turn `before`. */
double turnError(
    const ImuSamples& samples, std::size_t begin, std::size_t end, double gyro_scale,
    const Vector3d& before, const Vector3d& after)
{
    Matrix3d R = Matrix3d::Identity();
    for (std::size_t i = begin; i < end; i++)
        R = R * expSO3(samples[i].gyro * (gyro_scale * toSeconds(samples[i + 1].t - samples[i].t)));
    const Vector3d predicted = R.transpose() * before;
    return std::atan2(predicted.cross(after).norm(), predicted.dot(after));
}
}  // namespace

void ImuUnitJudge::add(const ImuSample& sample)
{
    samples_++;
    force_ += sample.accel.norm();
    if (sample.gyro.norm() > kFastestRate) too_fast_++;
    if (!window_.empty() && (sample.t - window_.front().t >= kWindow || window_.size() == kMost))
        closeWindow();
    window_.push_back(sample);
}

void ImuUnitJudge::closeWindow()
{
    const std::size_t n = window_.size();
    if (n >= kFewest)
    {
        const Vector3d before = meanAccel(window_, 0, n / 3) * accelScale();
        const Vector3d after = meanAccel(window_, n - n / 3, n) * accelScale();
        const bool gravity_alone =
            std::abs(before.norm() - kGravityWorld.norm()) < kRestTolerance &&
            std::abs(after.norm() - kGravityWorld.norm()) < kRestTolerance;
        const auto error = [&](double scale)
        { return turnError(window_, n / 6, n - 1 - n / 6, scale, before, after); };
        const double rad = error(1), deg = error(kDegree);
        if (gravity_alone && rad > std::max(kTurn, kClear * deg)) seconds_deg_++;
        if (gravity_alone && deg > std::max(kTurn, kClear * rad)) seconds_rad_++;
    }
    window_.clear();
}

double ImuUnitJudge::accelScale() const
{
    const double force = meanForce();
    if (force > 0.3 && force < 3) return kStandardGravity;
    if (force > 300 && force < 3000) return kStandardGravity / 1000;
    return 1;
}

ImuUnits ImuUnitJudge::units() const
{
    ImuUnits units;
    const double force = meanForce();
    units.accel_scale = accelScale();
    units.accel_fits = units.accel_scale != 1 || (force >= 5 && force <= 20);
    if (units.accel_scale != 1) units.accel_name = units.accel_scale > 1 ? "g" : "milli-g";
    units.accel_reason = text("its norm has a mean of %.4g", force);
    const bool too_fast = too_fast_ >= kNoOutliers;
    if (too_fast || seconds_deg_ > 2 * seconds_rad_)
    {
        units.gyro_name = "deg/s";
        units.gyro_scale = kDegree;
        units.gyro_reason =
            too_fast ? text("%.0f are too high for rad/s", static_cast<double>(too_fast_))
                     : text(
                           "gravity turns as deg/s say, not as rad/s, in %.0f s",
                           static_cast<double>(seconds_deg_));
    }
    else if (seconds_rad_ > 0)
        units.gyro_reason =
            text("gravity turns as rad/s say in %.0f s", static_cast<double>(seconds_rad_));
    else
        units.gyro_reason = "nothing speaks against it";
    return units;
}
}  // namespace taut
