#include "taut/odometry/Rest.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace taut
{
namespace
{
/** A body that is this many deviations from how it rested does not rest. */
constexpr double kLeft = 4;

// A turn in place.
constexpr double kSlowTurn = 0.2;  // [rad/s] a faster one is not told from leaving
constexpr double kCreep = 0.01;    // [m/s] that a body without any turn may have

/** How much of a displacement is along directions that the LiDAR tells better than the rest, which
 * holds the body within sigma. */
double seenOf(
    const Vector3d& displacement, const NavState::Matrix& lidar_information, int part, double sigma)
{
    const Matrix3d told = lidar_information.block<3, 3>(part, part);
    const Matrix3d both = told + Matrix3d::Identity() / square(sigma);
    return (both.inverse() * told * displacement).norm();
}
}  // namespace

Rest::Rest(const Initialization& initialization, const InitializationConfig& config)
    : lasts_(initialization.at_rest), lever_(config.sway_lever), reach_(config.max_sway)
{
    const NavState& x = initialization.estimate.state;
    end_ = x.t + fromSeconds(initialization.rest_duration);
    prior_.T_world_imu = x.T_world_imu;
    prior_.position_sigma = initialization.position_sigma;
    prior_.rotation_sigma = initialization.position_sigma / lever_;
}

MotionPrior Rest::at(
    const NavState& predicted, const NavState::Matrix& covariance, double angular_rate)
{
    if (!lasts_) return {};
    if (predicted.t <= end_) return prior_;
    const Matrix3d& R = prior_.T_world_imu.R;
    reach_ = std::max(reach_, lever_ * logSO3(R.transpose() * predicted.T_world_imu.R).norm());
    prior_.position_sigma = reach_;
    prior_.rotation_sigma = std::numeric_limits<double>::infinity();
    prior_.velocity_sigma = std::max(kCreep, lever_ * angular_rate);
    const Matrix3d expected = covariance.block<3, 3>(NavState::kVelocity, NavState::kVelocity) +
                              square(prior_.velocity_sigma) * Matrix3d::Identity();
    const Vector3d& v = predicted.v_world;
    lasts_ = angular_rate < kSlowTurn && v.dot(expected.inverse() * v) < square(kLeft);
    return lasts_ ? prior_ : MotionPrior{};
}

std::optional<Rest::Displacement> Rest::endIfLeft(
    const NavState& state, const NavState::Matrix& lidar_information)
{
    if (!lasts_) return std::nullopt;
    const bool found_by_imu = state.t <= end_;
    const Pose left = prior_.T_world_imu.inverse() * state.T_world_imu;
    Displacement seen;
    seen.moved = seenOf(
        prior_.T_world_imu.R * left.p, lidar_information, NavState::kPosition,
        prior_.position_sigma);
    if (found_by_imu)
        seen.turned =
            seenOf(logSO3(left.R), lidar_information, NavState::kRotation, prior_.rotation_sigma);
    lasts_ =
        seen.moved < kLeft * prior_.position_sigma && seen.turned < kLeft * prior_.rotation_sigma;
    if (lasts_ || !found_by_imu) return std::nullopt;
    return seen;
}
}  // namespace taut
