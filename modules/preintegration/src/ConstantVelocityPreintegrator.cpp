#include "taut/preintegration/ConstantVelocityPreintegrator.h"

#include <algorithm>
#include <stdexcept>

#include "chain.h"

IMPLEMENTS_MRPT_OBJECT(ConstantVelocityPreintegrator, taut::Preintegrator, taut)

namespace taut
{
void ConstantVelocityPreintegrator::configure(ConfigSection& section)
{
    section.key("acceleration", config.acceleration, kPositive, "m/s^2, 1 sigma");
    section.key("angular_acceleration", config.angular_acceleration, kPositive, "rad/s^2, 1 sigma");
    section.key("step", config.step, kPositive, "s, spacing of the chain's knots");
}

PreintegratedImu ConstantVelocityPreintegrator::integrate(
    const PreintegrationRequest& request) const
{
    if (request.end <= request.begin)
        throw std::invalid_argument("preintegration over an interval that is empty or backward");
    // The samples are made up so that the rate is the one at the end of the sweep before. From
    // there it is a state: what it changes by is told by the points of the sweep.
    const NavState& previous = request.previous;
    const Vector3d& rate = request.previous_rate;
    const Vector3d v_body = previous.T_world_imu.R.transpose() * previous.v_world;
    const auto sampleAt = [&](Time t) {
        return ImuSample{t, rate + previous.bias_gyro, rate.cross(v_body)};
    };

    // An unknown constant acceleration over the sweep, as the white noise of the same variance.
    const double duration = toSeconds(request.end - request.begin);
    const StepNoise noise{0, config.acceleration * std::sqrt(duration)};

    PreintegratedImu chain =
        startChain(sampleAt(request.end), Vector3d::Zero(), previous.bias_gyro);
    chain.gravity.setZero();
    chain.rate_walk = square(config.angular_acceleration) * duration;
    const Duration step = std::max<Duration>(1, fromSeconds(config.step));
    for (Time t = request.end - step; t > request.begin; t -= step)
        extendBackward(chain, sampleAt(t), noise);
    extendBackward(chain, sampleAt(request.begin), noise);

    chain.covariance.bottomRightCorner<3, 3>().diagonal().array() +=
        chain.rate_walk * duration * duration * duration / 3;
    chain.bias_walk_covariance.setIdentity();
    chain.bias_walk_covariance *= 1e-12;  // the made-up forces have no bias to learn
    chain.bias_walk_covariance.bottomRightCorner<3, 3>().diagonal().setConstant(
        chain.rate_walk * duration);
    return chain;
}
}  // namespace taut
