#pragma once

#include <cmath>

#include "numeric.h"
#include "taut/core/Imu.h"
#include "taut/core/NavState.h"
#include "taut/core/PreintegratedImu.h"

namespace taut::test
{
/** A body that turns about an axis of its own and is accelerated along a line in the world, both
 * steadily or swaying: its motion, and what an IMU measures of it, have a closed form. The
 * mid-point rule is exact where it does not sway. */
struct SteadyTurn
{
    Pose T_world_imu{expSO3({0.4, -0.7, 1.1}), {1, -2, 3}};  //!< at time 0
    Vector3d v_world{2, -1, 0.5};                            //!< [m/s] at time 0
    Vector3d rate{0.8, -1.5, 2.0};                           //!< [rad/s] in the body
    Vector3d acceleration{1.5, -2.5, 0.7};                   //!< [m/s^2] in the world
    double sway = 0, sway_rate = 20;  //!< rate and acceleration times 1 + sway sin(sway_rate t)
    Vector3d bias_accel{0.1, -0.05, 0.2}, bias_gyro{0.02, 0.01, -0.03};

    NavState at(Time t) const
    {
        const double s = toSeconds(t), phase = sway_rate * s;
        const double once = s + sway * (1 - std::cos(phase)) / sway_rate;  // integral of level()
        const double twice =
            0.5 * s * s + sway * (phase - std::sin(phase)) / (sway_rate * sway_rate);
        NavState x;
        x.t = t;
        x.T_world_imu.R = T_world_imu.R * expSO3(rate * once);
        x.T_world_imu.p = T_world_imu.p + v_world * s + acceleration * twice;
        x.v_world = v_world + acceleration * once;
        x.bias_accel = bias_accel;
        x.bias_gyro = bias_gyro;
        return x;
    }

    /** What rate and acceleration are multiplied by. */
    double level(Time t) const { return 1 + sway * std::sin(sway_rate * toSeconds(t)); }

    ImuSample sample(Time t) const
    {
        const Vector3d force = level(t) * acceleration + kGravityWorld;
        return {
            t, level(t) * rate + bias_gyro, at(t).T_world_imu.R.transpose() * force + bias_accel};
    }

    /** Samples from `begin` on, up to the first one at or after `end`. */
    ImuSamples samples(Time begin, Time end, Duration period) const
    {
        ImuSamples out;
        for (Time t = begin; t < end + period; t += period) out.push_back(sample(t));
        return out;
    }

    /** The true motion from `end` back to `t`, by its exact relations. */
    MotionDelta motion(Time end, Time t) const
    {
        const NavState k = at(end), x = at(t);
        const Matrix3d Rt = k.T_world_imu.R.transpose();
        const double d = toSeconds(end - t);
        MotionDelta m;
        m.gamma = Rt * x.T_world_imu.R;
        m.beta = Rt * (x.v_world - k.v_world - kGravityWorld * d);
        m.alpha =
            Rt * (x.T_world_imu.p - k.T_world_imu.p + k.v_world * d + 0.5 * kGravityWorld * d * d);
        return m;
    }

    /** A body at rest, tilted. */
    static SteadyTurn rest()
    {
        SteadyTurn body;
        body.v_world.setZero();
        body.rate.setZero();
        body.acceleration.setZero();
        return body;
    }
};

/** A state with everything drawn at random. */
inline NavState randomState(Random& random)
{
    NavState x;
    x.T_world_imu = {expSO3(random.vector(1)), random.vector(10)};
    x.v_world = random.vector(3);
    x.bias_accel = random.vector(0.1);
    x.bias_gyro = random.vector(0.02);
    return x;
}

/** The state moved at random by up to about `size` m, m/s and rad; its biases by a tenth of it. */
inline NavState disturbed(const NavState& x, Random& random, double size)
{
    NavState::Vector d;
    for (int i = 0; i < NavState::kSize; i++)
        d[i] = size * random.normal() * (i < NavState::kBiasAccel ? 1 : 0.1);
    NavState moved = x.retract(d);
    moved.t = x.t;
    return moved;
}
}  // namespace taut::test
