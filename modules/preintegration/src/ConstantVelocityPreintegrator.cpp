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
    const Matrix3d& R_begin = request.previous.T_world_imu.R;
    const Vector3d& rate = request.previous_rate;
    const Vector3d v_body = R_begin.transpose() * request.previous.v_world;
    const auto sampleAt = [&](Time t)
    {
        const Matrix3d R = R_begin * expSO3(rate * toSeconds(t - request.begin));
        return ImuSample{t, rate, rate.cross(v_body) + R.transpose() * kGravityWorld};
    };

    // An unknown constant acceleration over the sweep, as the white noise of the same variance.
    const double root = std::sqrt(toSeconds(request.end - request.begin));
    const StepNoise noise{
        config.angular_acceleration * root * root * root, config.acceleration * root};

    PreintegratedImu chain = startChain(sampleAt(request.end), Vector3d::Zero(), Vector3d::Zero());
    const Duration step = std::max<Duration>(1, fromSeconds(config.step));
    for (Time t = request.end - step; t > request.begin; t -= step)
        extendBackward(chain, sampleAt(t), noise);
    extendBackward(chain, sampleAt(request.begin), noise);

    chain.bias_walk_covariance.setIdentity();
    chain.bias_walk_covariance *= 1e-12;  // the made-up samples have no bias to learn
    return chain;
}
}  // namespace taut
