#include "taut/preintegration/Initializer.h"

#include <algorithm>
#include <cmath>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr double kGaugeSigma = 1e-5;         // position [m] and yaw [rad] are 0 by definition
constexpr double kRestVelocitySigma = 1e-3;  // [m/s]

// How much the means of windows may differ by the sensor's noise.
constexpr double kNoiseSigmas = 4;      // of their length, as they spread in the rest so far
constexpr double kMostNoise = 4;        // times what is asked for: more is motion
constexpr std::size_t kFewWindows = 8;  // fewer do not tell their spread

/** Joint covariance of (theta, ba) from a prior on both and the mean specific force
 * mean = R^T g + ba, known to sigma_mean. */
Eigen::Matrix<double, 6, 6> tiltAndBiasCovariance(
    const Matrix3d& R, double tilt_sigma, double bias_sigma, double sigma_mean)
{
    const Vector3d up_body = R.transpose() * Vector3d::UnitZ();
    Eigen::Matrix<double, 3, 6> J;
    J << hat(R.transpose() * kGravityWorld), Matrix3d::Identity();
    Eigen::Matrix<double, 6, 6> information = J.transpose() * J / square(sigma_mean);
    information.topLeftCorner<3, 3>() += Matrix3d::Identity() / square(tilt_sigma) +
                                         up_body * up_body.transpose() / square(kGaugeSigma);
    information.bottomRightCorner<3, 3>() += Matrix3d::Identity() / square(bias_sigma);
    return information.inverse();
}

/** Rotation body to world that turns the measured specific force upwards; yaw 0. */
Matrix3d attitudeFrom(const Vector3d& specific_force)
{
    const Vector3d f = specific_force.normalized();
    const double roll = std::atan2(f.y(), f.z());
    const double pitch = std::atan2(-f.x(), std::hypot(f.y(), f.z()));
    return (Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll, Vector3d::UnitX()))
        .toRotationMatrix();
}
}  // namespace

void InitializationConfig::declare(ConfigSection& s)
{
    s.key("rest_duration", rest_duration, kPositive, "s, rest that is waited for");
    s.key("min_rest", min_rest, kPositive, "s, a rest cut short is used down to this");
    s.choice<OnMotion>(
        "on_motion", on_motion, {{"start", OnMotion::Start}, {"wait", OnMotion::Wait}},
        "without a rest: start in motion, or wait for one");
    s.key("window", window, kPositive, "s, window of the rest detection");
    s.key("max_rate_change", max_rate_change, kPositive, "rad/s, between means of windows");
    s.key("max_accel_change", max_accel_change, kPositive, "m/s^2, between means of windows");
    s.key("max_gyro_bias", max_gyro_bias, kPositive, "rad/s, a higher steady rate is motion");
    s.key("gravity_tolerance", gravity_tolerance, kPositive, "m/s^2, mean specific force to 9.81");
    s.key(
        "sway_lever", sway_lever, kPositive,
        "m, a body at rest, or turning in place, moves by this times its rotation");
    s.key("min_sway", min_sway, kPositive, "m, and at least");
    s.key("max_sway", max_sway, kPositive, "m, and at most: after the rest, or one cut short");
    if (min_sway > max_sway) throw ConfigError(s.path() + ": min_sway exceeds max_sway");
    s.key("accel_bias_sigma", accel_bias_sigma, kPositive, "m/s^2, absolute prior");
    s.key("gyro_bias_sigma", gyro_bias_sigma, kPositive, "rad/s, absolute prior");
    s.key("moving_tilt_sigma", moving_tilt_sigma, kPositive, "rad, prior of a start in motion");
    s.key("moving_velocity_sigma", moving_velocity_sigma, kPositive, "m/s, the same");
}

void Initializer::Window::add(const ImuSample& s)
{
    if (count == 0) begin = s.t;
    end = s.t;
    count++;
    gyro_sum += s.gyro;
    accel_sum += s.accel;
    gyro_square += s.gyro.cwiseAbs2();
    accel_square += s.accel.cwiseAbs2();
}

void Initializer::Window::add(const Window& w)
{
    if (count == 0) begin = w.begin;
    end = w.end;
    count += w.count;
    gyro_sum += w.gyro_sum;
    accel_sum += w.accel_sum;
    gyro_square += w.gyro_square;
    accel_square += w.accel_square;
}

Initializer::Initializer(const InitializationConfig& config, WarningSink warn)
    : config_(config), warn_(std::move(warn))
{
}

bool Initializer::add(const ImuSample& sample)
{
    if (result_) return true;
    current_.add(sample);
    if (toSeconds(current_.end - current_.begin) >= config_.window) closeWindow();
    return result_.has_value();
}

std::optional<Time> Initializer::earliestStart() const
{
    // Whoever may start in motion starts with the first sample.
    if (first_.count > 0 && config_.on_motion == OnMotion::Start) return first_.begin;
    if (rest_.count > 0) return rest_.begin;
    if (current_.count > 0) return current_.begin;
    return std::nullopt;
}

bool Initializer::finish()
{
    if (result_) return true;
    // The window cut short by the end says little, its mean is noisy; but it may be all there is.
    if (current_.count > 0 && first_.count == 0) closeWindow();
    if (result_ || first_.count == 0) return result_.has_value();
    const double rested = rest_.count > 0 ? toSeconds(rest_.end - rest_.begin) : 0;
    if (rested >= config_.min_rest)
        result_ = fromRest();
    else if (config_.on_motion == OnMotion::Start)
        startInMotion(first_.begin, rested);
    else
        reportWaiting(current_.count > 0 ? current_.begin : first_.begin, rested);
    return result_.has_value();
}

void Initializer::closeWindow()
{
    const Window w = current_;
    current_ = {};
    if (first_.count == 0) first_ = w;
    if (!plausibleRest(w) || (rest_.count > 0 && !continuesRest(w)))
    {
        onMotion(w.begin);
        return;
    }
    rest_.add(w);
    rests_.push_back(w);
    if (restedFully()) result_ = fromRest();
}

bool Initializer::plausibleRest(const Window& w) const
{
    return w.gyroMean().norm() < config_.max_gyro_bias &&
           std::abs(w.accelMean().norm() - kGravityWorld.norm()) < config_.gravity_tolerance;
}

bool Initializer::continuesRest(const Window& w) const
{
    // Means of windows differ by the noise of the sensor, too: as those of the rest so far do.
    const auto most = [&](double asked, const Vector3d& spread)
    { return std::clamp(kNoiseSigmas * spread.norm(), asked, kMostNoise * asked); };
    const auto [gyro, accel] = spreadOfRest();
    return (w.gyroMean() - rest_.gyroMean()).norm() < most(config_.max_rate_change, gyro) &&
           (w.accelMean() - rest_.accelMean()).norm() < most(config_.max_accel_change, accel);
}

std::pair<Vector3d, Vector3d> Initializer::spreadOfRest() const
{
    if (rests_.size() < kFewWindows)
    {
        // Too few to tell; white noise is averaged by the root of the number of samples.
        const double n = rests_.front().count;
        const auto spread = [&](const Vector3d& square, const Vector3d& mean) -> Vector3d
        { return ((square / rest_.count - mean.cwiseAbs2()).cwiseMax(0) / n).cwiseSqrt(); };
        return {
            spread(rest_.gyro_square, rest_.gyroMean()),
            spread(rest_.accel_square, rest_.accelMean())};
    }
    Vector3d gyro = Vector3d::Zero(), accel = Vector3d::Zero();
    for (const Window& w : rests_)
    {
        gyro += (w.gyroMean() - rest_.gyroMean()).cwiseAbs2();
        accel += (w.accelMean() - rest_.accelMean()).cwiseAbs2();
    }
    const double n = static_cast<double>(rests_.size() - 1);
    return {(gyro / n).cwiseSqrt(), (accel / n).cwiseSqrt()};
}

void Initializer::onMotion(Time t)
{
    const double rested = rest_.count > 0 ? toSeconds(rest_.end - rest_.begin) : 0;
    if (rested >= config_.min_rest)
    {
        result_ = fromRest();
        if (warn_)
            warn_(
                {t, "short_rest",
                 format(
                     "the body moves after %.1f s of rest (asked for %.1f s): starting with the "
                     "gravity and biases of the shorter rest",
                     rested, config_.rest_duration)});
        return;
    }
    rest_ = {};
    rests_.clear();
    if (config_.on_motion == OnMotion::Start)
    {
        startInMotion(t, rested);
    }
    else
    {
        reportWaiting(t, rested);
    }
}

void Initializer::reportWaiting(Time t, double rested)
{
    if (!waiting_reported_ && warn_)
        warn_(
            {t, "no_rest",
             format(
                 "the body moves (rested for %.1f s): waiting for a rest of %.1f s", rested,
                 config_.min_rest)});
    waiting_reported_ = true;
}

void Initializer::startInMotion(Time t, double rested)
{
    result_ = fromMotion();
    if (warn_)
        warn_(
            {t, "no_rest",
             format(
                 "no rest at the start (%.1f s, needs at least %.1f s): starting in motion, "
                 "gravity and biases are known poorly at first",
                 rested, config_.min_rest)});
}

bool Initializer::restedFully() const
{
    return toSeconds(rest_.end - rest_.begin) >= config_.rest_duration - config_.window;
}

double Initializer::swayAtRest() const
{
    if (!restedFully()) return config_.max_sway;
    const Vector3d bias = rest_.gyroMean();
    Vector3d turned = Vector3d::Zero();
    double furthest = 0;
    for (const Window& w : rests_)
    {
        turned += (w.gyroMean() - bias) * toSeconds(w.end - w.begin);
        furthest = std::max(furthest, turned.norm());
    }
    return std::clamp(config_.sway_lever * furthest, config_.min_sway, config_.max_sway);
}

Initialization Initializer::fromRest() const
{
    const Window& w = rest_;
    const Vector3d force = w.accelMean();
    const double seconds = toSeconds(w.end - w.begin);
    const double dt = seconds / std::max(1, w.count - 1);
    const Vector3d accel_variance = w.accel_square / w.count - force.cwiseAbs2();
    const Vector3d gyro_variance = w.gyro_square / w.count - w.gyroMean().cwiseAbs2();

    Initialization init;
    init.rest_duration = seconds;
    init.position_sigma = swayAtRest();
    init.measured_noise = {};
    init.measured_noise.accel = std::sqrt(std::max(0.0, accel_variance.mean()) * dt);
    init.measured_noise.gyro = std::sqrt(std::max(0.0, gyro_variance.mean()) * dt);

    NavState& x = init.estimate.state;
    x.t = w.begin;
    x.T_world_imu.R = attitudeFrom(force);
    x.bias_accel = force - x.T_world_imu.R.transpose() * kGravityWorld;
    x.bias_gyro = w.gyroMean();

    auto& P = init.estimate.covariance;
    P.setZero();
    const double sigma_mean = 2e-3 + init.measured_noise.accel / std::sqrt(seconds);
    const auto joint =
        tiltAndBiasCovariance(x.T_world_imu.R, 1.0, config_.accel_bias_sigma, sigma_mean);
    const double gyro_sigma = 1e-4 + init.measured_noise.gyro / std::sqrt(seconds);
    P.block<3, 3>(NavState::kPosition, NavState::kPosition)
        .diagonal()
        .setConstant(square(kGaugeSigma));
    P.block<3, 3>(NavState::kVelocity, NavState::kVelocity)
        .diagonal()
        .setConstant(square(kRestVelocitySigma));
    P.block<6, 6>(NavState::kRotation, NavState::kRotation) = joint;  // theta and ba are neighbours
    P.block<3, 3>(NavState::kBiasGyro, NavState::kBiasGyro)
        .diagonal()
        .setConstant(square(gyro_sigma));
    return init;
}

Initialization Initializer::fromMotion() const
{
    Initialization init;
    init.at_rest = false;
    init.measured_noise.accel = init.measured_noise.gyro = 0;
    NavState& x = init.estimate.state;
    x.t = first_.begin;
    x.T_world_imu.R = attitudeFrom(first_.accelMean());

    auto& P = init.estimate.covariance;
    P.setZero();
    const double sigma_mean = config_.moving_tilt_sigma * kGravityWorld.norm();
    P.block<3, 3>(NavState::kPosition, NavState::kPosition)
        .diagonal()
        .setConstant(square(kGaugeSigma));
    P.block<3, 3>(NavState::kVelocity, NavState::kVelocity)
        .diagonal()
        .setConstant(square(config_.moving_velocity_sigma));
    P.block<6, 6>(NavState::kRotation, NavState::kRotation) = tiltAndBiasCovariance(
        x.T_world_imu.R, config_.moving_tilt_sigma, config_.accel_bias_sigma, sigma_mean);
    P.block<3, 3>(NavState::kBiasGyro, NavState::kBiasGyro)
        .diagonal()
        .setConstant(square(config_.gyro_bias_sigma));
    return init;
}
}  // namespace taut
