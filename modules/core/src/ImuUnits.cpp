#include "taut/core/ImuUnits.h"

#include <algorithm>
#include <cmath>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr Duration kWindow = 1'000'000'000;
constexpr std::size_t kFewest = 10, kMost = 10'000;  // samples of a window
constexpr double kStandardGravity = 9.80665;         // m/s^2: what "1 g" means
constexpr std::size_t kNoOutliers = 5;  // samples that are too fast by mistake are fewer
constexpr double kRestTolerance = 0.5;  // m/s^2 about gravity: little else is felt
constexpr double kClear = 3;            // so much better one unit must explain the turn, and
constexpr double kTurn = 0.05;          // rad, this wrong the other must be
constexpr double kBiasTurn = 0.25;      // rad, that a bias or noise does not feign in a second

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

Unit accelUnit(double mean_force)
{
    if (mean_force > 0.3 && mean_force < 3) return {"g", kStandardGravity};
    if (mean_force >= 5 && mean_force <= 20) return {"m/s^2", 1};
    if (mean_force > 300 && mean_force < 3000) return {"milli-g", kStandardGravity / 1000};
    return {"unknown", 1};
}

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
        const double to_si = accelUnit(meanForce()).factor;
        const Vector3d before = meanAccel(window_, 0, n / 3) * to_si;
        const Vector3d after = meanAccel(window_, n - n / 3, n) * to_si;
        const bool gravity_alone =
            std::abs(before.norm() - kGravityWorld.norm()) < kRestTolerance &&
            std::abs(after.norm() - kGravityWorld.norm()) < kRestTolerance;
        const auto error = [&](double scale)
        { return turnError(window_, n / 6, n - 1 - n / 6, scale, before, after); };
        const double rad = error(1), deg = error(kDegree);
        // At rest a bias turns as if it were a rate in rad/s that is too high.
        const double turned = std::atan2(before.cross(after).norm(), before.dot(after));
        if (gravity_alone && rad > std::max(turned > kTurn ? kTurn : kBiasTurn, kClear * deg))
            seconds_deg_++;
        if (gravity_alone && deg > std::max(kTurn, kClear * rad)) seconds_rad_++;
    }
    window_.clear();
}

bool ImuUnitJudge::tooFastForRadians() const
{
    return too_fast_ >= kNoOutliers;
}

bool ImuUnitJudge::gyroInDegrees() const
{
    return tooFastForRadians() || seconds_deg_ > 2 * seconds_rad_;
}

ImuUnits ImuUnitJudge::units() const
{
    ImuUnits units;
    units.accel = accelUnit(meanForce());
    units.accel_reason = format("its norm has a mean of %.4g", meanForce());
    if (gyroInDegrees())
    {
        units.gyro = {"deg/s", kDegree};
        units.gyro_reason =
            tooFastForRadians()
                ? format("%zu are too high for rad/s", too_fast_)
                : format("gravity turns as deg/s say, not as rad/s, in %zu s", seconds_deg_);
    }
    else if (seconds_rad_ > 0)
        units.gyro_reason = format("gravity turns as rad/s say in %zu s", seconds_rad_);
    else
        units.gyro_reason = "nothing speaks against it";
    return units;
}
}  // namespace taut
