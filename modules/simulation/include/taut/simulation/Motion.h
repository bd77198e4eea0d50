#pragma once

#include <Eigen/Core>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut::simulation
{
/** The true motion of the body (IMU) at one instant, with its exact derivatives. */
struct MotionState
{
    Pose T_world_imu;
    Vector3d v_world = Vector3d::Zero();               //!< [m/s]
    Vector3d a_world = Vector3d::Zero();               //!< [m/s^2], without gravity
    Vector3d rate = Vector3d::Zero();                  //!< angular rate, body frame [rad/s]
    Vector3d angular_acceleration = Vector3d::Zero();  //!< body frame [rad/s^2]
};

/** A smooth path of the body: a uniform B-spline of degree five over position and quaternion, so
 * four times continuously differentiable. What the spline passes through is the truth; the poses
 * that it was made of are only its control points (it stays within their convex hull). */
class Motion
{
 public:
    static constexpr int kDegree = 5;
    /** Control point m acts around the time (m - kLead) * spacing. */
    static constexpr int kLead = 2;

    /** @param controls poses, consecutive ones less than half a turn apart; at least 6
     *  @param spacing time between control points [s] */
    Motion(const std::vector<Pose>& controls, double spacing);

    /** Number of control points for a motion over [0, duration]. */
    static std::size_t controlsFor(double duration, double spacing);

    double duration() const;  //!< [s]; defined over [0, duration]

    /** State at t [s], clamped to [0, duration]. */
    MotionState at(double t) const;
    /** Pose alone: cheaper. */
    Pose poseAt(double t) const;

 private:
    using Control = Eigen::Matrix<double, 7, 1>;  // position, quaternion x y z w
    using Weights = Eigen::Matrix<double, kDegree + 1, 1>;

    std::size_t segmentOf(double t, double& fraction) const;

    std::vector<Control, Eigen::aligned_allocator<Control>> controls_;
    double spacing_;
};
}  // namespace taut::simulation
