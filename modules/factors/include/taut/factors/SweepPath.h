#pragma once

#include <cstdint>
#include <string>

#include "taut/core/Config.h"
#include "taut/core/NavState.h"
#include "taut/core/PreintegratedImu.h"

namespace taut
{
/** How the points of a sweep are undistorted (docs/equations.md). */
enum class Undistortion
{
    None,         //!< not at all: every point is seen from the pose at the scan's end
    Rotation,     //!< gyro only, one pass
    Imu,          //!< gyro and accelerometer from the a-priori state, one pass
    IteratedImu,  //!< the a-priori equation, evaluated again in every iteration
    Iterated,     //!< the paper: the gap to the previous state spread linearly over the sweep
    Bridge,       //!< its exact form: the most probable path between both states
};

/** True for the modes whose path changes with every iteration. */
bool isIterated(Undistortion mode);

/** Declares key `undistortion` with the names of the modes. */
void declareUndistortion(ConfigSection& section, Undistortion& mode);
const char* nameOf(Undistortion mode);

/** Derivative of a pose on the path by both states (x_{k-1}, x_k), 6 x 30: rows dp [m] in the
 * world, then dtheta [rad] on the right. */
using PathJacobian = Eigen::Matrix<double, 6, 2 * NavState::kSize>;

/** The path of the body through one sweep, T_world_imu(t) for t in (t_{k-1}, t_k], as both states
 * and the preintegrated motion tell it (paper, equations 10 to 12). */
class SweepPath
{
 public:
    /** The a-priori states fix the path of the one-pass modes relative to x_k. */
    SweepPath(
        Undistortion mode, const PreintegratedImu& imu, const NavState& prior_previous,
        const NavState& prior_current);

    /** Moves both ends. */
    void setStates(const NavState& previous, const NavState& current);

    /** Another number whenever the path changes; copies share it until they change. */
    std::uint64_t revision() const { return revision_; }

    /** The pose at time t. `hint` as in PreintegratedImu::at(). */
    Pose poseAt(Time t, std::size_t& hint) const;

    /** The pose at time t and its derivative by both states. */
    Pose poseAt(Time t, std::size_t& hint, PathJacobian& jacobian) const;

 private:
    struct Local  // the body at t in the frame at t_k
    {
        double d = 0, mu = 0;
        Vector3d turn = Vector3d::Zero();            // Log of the correction
        double by_rate = 0;                          // share of the rate gap in it [s]
        double turned = 0;                           // share of the rotation gap, closed at t
        MotionDelta motion;                          // corrected for the current biases
        Pose apriori;                                // (Rbar_j, pbar_j)
        Pose corrected;                              // (Rcheck_j, pcheck_j)
        Matrix3d correction = Matrix3d::Identity();  // dR_j
    };

    Local localAt(Time t, const Motion& motion, std::size_t hint) const;
    bool rateIsState() const;
    Vector3d aprioriPosition(double d, const Motion& motion) const;
    void rotationJacobian(const Local& at, const MotionDelta& motion, PathJacobian& J) const;
    void positionJacobian(const Local& at, const MotionDelta& motion, PathJacobian& J) const;

    std::uint64_t revision_ = 0;
    Undistortion mode_;
    const PreintegratedImu& imu_;
    PreintegratedImu chain_;  // for the current biases
    NavState prior_current_, previous_, current_;
    MotionDelta start_;                     // motion back to t_{k-1}, for the current biases
    double duration_;                       // Delta [s]
    Pose apriori_start_;                    // (gamma, pbar) at t_{k-1}
    Matrix3d gap_rotation_;                 // R_D
    Vector3d gap_log_;                      // Log R_D
    Vector3d gap_rate_;                     // of the rates at both ends, where they are states
    Vector3d gap_translation_;              // p_D (iterated)
    Vector3d gap_position_, gap_velocity_;  // e_p, e_v (bridge)
};
}  // namespace taut
