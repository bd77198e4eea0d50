#pragma once

#include <Eigen/Core>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** Kinetic state of the body at the end of a scan. Order of the error state (15): p, v, theta, ba,
 * bg; the rotation is perturbed on the right (docs/conventions.md; paper, equation 16). */
struct NavState
{
    static constexpr int kSize = 15;
    static constexpr int kPosition = 0, kVelocity = 3, kRotation = 6, kBiasAccel = 9,
                         kBiasGyro = 12;
    using Vector = Eigen::Matrix<double, kSize, 1>;
    using Matrix = Eigen::Matrix<double, kSize, kSize>;

    Time t = 0;
    Pose T_world_imu;
    Vector3d v_world = Vector3d::Zero();     //!< [m/s]
    Vector3d bias_accel = Vector3d::Zero();  //!< [m/s^2]
    Vector3d bias_gyro = Vector3d::Zero();   //!< [rad/s]

    /** This state moved by an error-state vector. */
    NavState retract(const Vector& delta) const;

    /** The error-state vector that moves `origin` to this state: origin.retract(d) = *this. */
    Vector localFrom(const NavState& origin) const;
};

/** A state and how well it is known. */
struct NavEstimate
{
    NavState state;
    NavState::Matrix covariance = NavState::Matrix::Zero();
};
}  // namespace taut
