#include "GyroPathPreintegrator.h"

#include <algorithm>

IMPLEMENTS_MRPT_OBJECT(GyroPathPreintegrator, taut::Preintegrator, taut)

namespace taut
{
namespace
{
constexpr Duration kStep = 5'000'000;
constexpr double kRotationSigma = 0.1;  // [rad] of the rotation over a sweep
constexpr double kVelocitySigma = 1.0;  // [m/s] of the change of velocity over a sweep
}  // namespace

void GyroPathPreintegrator::use(const GyroRotation& gyro, double clock_offset)
{
    gyro_ = &gyro;
    clock_offset_ = fromSeconds(clock_offset);
}

/* The readings of an IMU that measures the gyro's rates at a constant velocity are made up. */
PreintegratedImu GyroPathPreintegrator::integrate(const PreintegrationRequest& request) const
{
    PreintegrationRequest made_up = request;
    ImuSamples samples;
    Matrix3d R = request.previous.T_world_imu.R;
    const auto rateAt = [&](Time t)
    {
        const Time at = t + clock_offset_;
        return gyro_->meanRate(at - kStep / 2, at + kStep / 2).value_or(request.previous_rate);
    };
    samples.push_back({request.begin, rateAt(request.begin), R.transpose() * kGravityWorld});
    while (samples.back().t < request.end)
    {
        const ImuSample last = samples.back();
        const Time t = std::min(last.t + kStep, request.end);
        const Vector3d rate = rateAt(t);
        R = R * expSO3((last.gyro + rate) / 2 * toSeconds(t - last.t));
        samples.push_back({t, rate, R.transpose() * kGravityWorld});
    }
    made_up.samples = &samples;
    made_up.previous.bias_accel.setZero();
    made_up.previous.bias_gyro.setZero();
    const double root = std::sqrt(toSeconds(request.end - request.begin));
    made_up.noise.gyro = kRotationSigma / root;
    made_up.noise.accel = kVelocitySigma / root;
    return midpoint_.integrate(made_up);
}
}  // namespace taut
