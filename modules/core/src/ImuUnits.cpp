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

/** Norm of the mean force in the frame of the first sample, by the rates: what oscillates goes
 * away, gravity stays. */
double steadyForce(const ImuSamples& samples, double gyro_scale)
{
    Matrix3d R = Matrix3d::Identity();
    Vector3d sum = samples.front().accel;
    for (std::size_t i = 1; i < samples.size(); i++)
    {
        const double dt = toSeconds(samples[i].t - samples[i - 1].t);
        R = R * expSO3(samples[i].gyro * (gyro_scale * dt));
        sum += R * samples[i].accel;
    }
    return sum.norm() / static_cast<double>(samples.size());
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
        steady_ += std::max(steadyForce(window_, 1), steadyForce(window_, kDegree));
        seconds_++;
        const Unit unit = accelUnit(meanForce());
        const double to_si = unit.factor;
        const Vector3d before = meanAccel(window_, 0, n / 3) * to_si;
        const Vector3d after = meanAccel(window_, n - n / 3, n) * to_si;
        const bool gravity_alone =
            (to_si == 1 || showsGravity(unit)) &&
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

/** Whether the force is such as gravity in this unit makes it: a body that moves may have a mean
 * norm near 1 m/s^2 without gravity, too. */
bool ImuUnitJudge::showsGravity(const Unit& unit) const
{
    const double gravity = kStandardGravity / unit.factor;
    const auto near = [&](double value, double most)
    { return value > 0.75 * gravity && value < most * gravity; };
    return near(meanForce(), 1.6) &&
           (seconds_ == 0 || near(steady_ / static_cast<double>(seconds_), 1.35));
}

ImuUnits ImuUnitJudge::units() const
{
    ImuUnits units;
    units.accel = accelUnit(meanForce());
    units.accel_reason = format("its norm has a mean of %.4g", meanForce());
    if (units.accel.known() && units.accel.factor != 1 && !showsGravity(units.accel))
    {
        units.accel = {"unknown", 1};
        units.accel_reason += seconds_ == 0
                                  ? std::string()
                                  : format(
                                        ", and %.4g of it stay while the body turns, as if gravity "
                                        "was taken out: the raw specific force is needed",
                                        steady_ / static_cast<double>(seconds_));
    }
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
