#include "taut/inspection/ImuInspector.h"

#include <algorithm>
#include <cmath>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr Duration kSecond = 1'000'000'000;
constexpr std::size_t kMostOfASecond = 10'000;
constexpr double kGapIntervals = 3.5;         // times the usual interval, and
constexpr double kGapSeconds = 0.03;          // what the preintegration calls a gap
constexpr double kJitter = 0.1;               // share of intervals half off the usual one
constexpr double kSlowest = 50;               // Hz
constexpr std::size_t kClipped = 5;           // samples that share their extreme
constexpr double kSmallestGyroRange = 2.0;    // rad/s: no gyro ends below 125 deg/s
constexpr double kSmallestAccelRange = 19.0;  // m/s^2: nor an accelerometer below 2 g
constexpr double kRestTolerance = 0.5;        // s, windows of the rest detection
constexpr double kNoiseFactor = 2;            // of the noise that is expected
constexpr double kForceTolerance = 0.3;       // m/s^2 of the norm at rest

InitializationConfig toTheEndOfTheRest()
{
    InitializationConfig config;
    config.rest_duration = 1e9;
    return config;
}
}  // namespace

ImuInspector::ImuInspector()
    : rest_rad_(toTheEndOfTheRest(), {}), rest_deg_(toTheEndOfTheRest(), {})
{
}

void ImuInspector::Extreme::add(double v, Time t)
{
    if (v < value) return;
    if (v > value) *this = {v, 0, t};
    count++;
}

void ImuInspector::add(Extremes& extremes, const Vector3d& v, Time t)
{
    for (int axis = 0; axis < 3; axis++)
    {
        extremes[2 * axis].add(v[axis], t);
        extremes[2 * axis + 1].add(-v[axis], t);
    }
}

double ImuInspector::largest(const Extremes& extremes)
{
    double most = 0;
    for (const Extreme& e : extremes) most = std::max(most, e.value);
    return most;
}

void ImuInspector::add(const ImuSample& sample)
{
    if (samples_ == 0)
        first_ = sample.t;
    else
        intervals_.add(last_, sample.t - last_);
    samples_++;
    last_ = sample.t;
    unit_judge_.add(sample);
    add(gyro_extremes_, sample.gyro, sample.t);
    add(accel_extremes_, sample.accel, sample.t);
    if (rest_started_)
    {
        addToRest(sample);
        return;
    }
    first_second_.push_back(sample);
    if (sample.t - first_ >= kSecond || first_second_.size() >= kMostOfASecond) startRest();
}

/* The unit of the specific force must be known before a rest can be seen. */
void ImuInspector::startRest()
{
    rest_started_ = true;
    if (first_second_.empty()) return;
    for (const ImuSample& s : first_second_) mean_force_ += s.accel.norm();
    mean_force_ /= static_cast<double>(first_second_.size());
    accel_unit_ = accelUnit(mean_force_);
    for (const ImuSample& s : first_second_) addToRest(s);
    first_second_ = {};
}

void ImuInspector::addToRest(const ImuSample& sample)
{
    ImuSample s = sample;
    s.accel *= accel_unit_.factor;
    rest_rad_.add(s);
    s.gyro *= kDegree;
    rest_deg_.add(s);
}

void ImuInspector::finish()
{
    if (!rest_started_) startRest();
    rest_rad_.finish();
    rest_deg_.finish();
}

ImuFacts ImuInspector::facts(std::optional<bool> gyro_in_degrees) const
{
    ImuFacts f;
    f.samples = samples_;
    f.first = first_;
    f.last = last_;
    f.rate = intervals_.median() > 0 ? 1 / intervals_.median() : 0;
    f.accel_unit = accel_unit_;
    const bool degrees = gyro_in_degrees.value_or(unit_judge_.tooFastForRadians());
    f.gyro_unit = degrees ? Unit{"deg/s", kDegree} : Unit{"rad/s", 1};
    f.max_gyro = largest(gyro_extremes_) * f.gyro_unit.factor;
    f.max_accel = largest(accel_extremes_) * f.accel_unit.factor;
    f.mean_force = mean_force_ * f.accel_unit.factor;
    f.noise = {0, 0, 0, 0};
    const auto& rest = (degrees ? rest_deg_ : rest_rad_).result();
    if (!rest || !rest->at_rest) return f;
    f.rest = rest->rest_duration;
    f.noise.gyro = rest->measured_noise.gyro;
    f.noise.accel = rest->measured_noise.accel;
    const NavState& x = rest->estimate.state;
    f.bias_gyro = x.bias_gyro;
    f.force_at_rest = (x.bias_accel + x.T_world_imu.R.transpose() * kGravityWorld).norm();
    return f;
}

Findings ImuInspector::findings(const ImuFacts& facts, const ImuNoise& expected) const
{
    Findings found;
    addTiming(facts, found);
    addUnits(facts, found);
    addClipping(gyro_extremes_, "gyro", facts.gyro_unit.factor, kSmallestGyroRange, "rad/s", found);
    addClipping(
        accel_extremes_, "accelerometer", facts.accel_unit.factor, kSmallestAccelRange, "m/s^2",
        found);
    addRest(facts, expected, found);
    return found;
}

void ImuInspector::addTiming(const ImuFacts& facts, Findings& found) const
{
    const double usual = intervals_.median();
    const double gap = std::max(kGapSeconds, kGapIntervals * usual);
    if (const std::size_t gaps = intervals_.longer(gap); gaps > 0)
    {
        const auto& worst = intervals_.largest().front();
        found.push_back(
            {worst.begin, "imu_gap", toSeconds(worst.length), "s", gaps,
             format(
                 "no IMU sample for %.3f s, where one comes every %.4f s", toSeconds(worst.length),
                 usual),
             "samples were lost or a clock was set forward: look at the cable, the load of the "
             "computer and the queue of the "
             "recorder; motion within a gap is only interpolated"});
    }
    const double n = static_cast<double>(std::max<std::size_t>(1, intervals_.count()));
    const double uneven =
        static_cast<double>(intervals_.shorter(0.5 * usual) + intervals_.longer(1.5 * usual)) / n;
    if (uneven > kJitter)
        found.push_back(
            {0, "imu_jitter", 100 * uneven, "%", 1,
             format(
                 "%.0f %% of the IMU's intervals are half off the usual %.4f s", 100 * uneven,
                 usual),
             "the stamps are probably those of arrival: let the driver use the sensor's clock"});
    if (facts.rate > 0 && facts.rate < kSlowest)
        found.push_back(
            {0, "imu_slow", facts.rate, "Hz", 1,
             format("the IMU gives %.1f samples a second", facts.rate),
             "configure 100 Hz or more: motion between samples is lost"});
}

void ImuInspector::addUnits(const ImuFacts& facts, Findings& found) const
{
    if (!accel_unit_.known())
        found.push_back(
            {first_, "imu_units", mean_force_, "as recorded", 1,
             format(
                 "the mean specific force of the first second is %.4g: neither 9.8 m/s^2 nor 1 g",
                 mean_force_),
             "find out the unit and set imu.accel_scale in the rig file"});
    else if (accel_unit_.factor != 1)
        found.push_back(
            {first_, "imu_units", mean_force_, accel_unit_.name, 1,
             format(
                 "the specific force is in %s: %.4g in the first second", accel_unit_.name.c_str(),
                 mean_force_),
             format("set imu.accel_scale: %.8g in the rig file", accel_unit_.factor)});
    if (facts.gyro_unit.factor != 1)
        found.push_back(
            {first_, "imu_units", facts.max_gyro / facts.gyro_unit.factor, "deg/s", 1,
             format("the rates are in deg/s: up to %.4g", facts.max_gyro / facts.gyro_unit.factor),
             format("set imu.gyro_scale: %.10g in the rig file", facts.gyro_unit.factor)});
}

void ImuInspector::addClipping(
    const Extremes& extremes, const std::string& sensor, double factor, double smallest,
    const std::string& unit, Findings& found)
{
    for (std::size_t i = 0; i < extremes.size(); i++)
    {
        const Extreme& e = extremes[i];
        if (e.count < kClipped || e.value * factor < smallest) continue;
        const std::string axis = {i % 2 == 0 ? '+' : '-', "xyz"[i / 2]};
        found.push_back(
            {e.first, sensor == "gyro" ? "gyro_clipped" : "accel_clipped", e.value * factor, unit,
             e.count,
             format(
                 "%zu samples share the extreme of the %s along %s, %.4g %s: clipped", e.count,
                 sensor.c_str(), axis.c_str(), e.value * factor, unit.c_str()),
             "choose a larger range in the IMU's settings, or move less violently"});
    }
}

void ImuInspector::addRest(const ImuFacts& f, const ImuNoise& expected, Findings& found) const
{
    const double asked = InitializationConfig{}.rest_duration;
    if (f.rest == 0)
        found.push_back(
            {first_, "no_rest", 0, "s", 1, "the body moves from the start on",
             format(
                 "let it lie still for %.0f s at the start; without, gravity and biases are known "
                 "poorly at first",
                 asked)});
    else if (f.rest < asked - kRestTolerance)
        found.push_back(
            {first_, "short_rest", f.rest, "s", 1,
             format("the body rests for %.1f s at the start", f.rest),
             format(
                 "%.0f s are wanted: gravity and biases get better with the root of the time",
                 asked)});
    if (f.rest == 0) return;
    const auto addNoise = [&](const char* sensor, double seen, double limit, const char* unit)
    {
        if (seen <= kNoiseFactor * limit) return;
        found.push_back(
            {first_, std::string(sensor) + "_noise", seen, unit, 1,
             format(
                 "at rest the %s has a noise of %.2g %s, where %.2g is expected", sensor, seen,
                 unit, limit),
             "an engine or fan that shakes the mount, or a noisy sensor: taut raises its noise to "
             "this by itself unless the rig file states another"});
    };
    addNoise("gyro", f.noise.gyro, expected.gyro, "rad/s/sqrt(Hz)");
    addNoise("accel", f.noise.accel, expected.accel, "m/s^2/sqrt(Hz)");
    if (std::abs(f.force_at_rest - kGravityWorld.norm()) > kForceTolerance)
        found.push_back(
            {first_, "gravity", f.force_at_rest, "m/s^2", 1,
             format("at rest the specific force is %.3f m/s^2, not 9.81", f.force_at_rest),
             "the accelerometer has a bias or a wrong scale: calibrate it, or set imu.accel_scale "
             "in the rig file"});
}
}  // namespace taut
