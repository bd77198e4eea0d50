#pragma once

#include <Eigen/Core>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"

namespace taut
{
/** Backward preintegrated motion at one time t <= t_k (paper, equation 7). All in the body frame at
 * t_k; `gamma` = R_{b_t}^{b_k}. The integrals are signed: they run backward, so beta of a body at
 * rest is -g d and alpha +1/2 g d^2. */
struct Motion
{
    Matrix3d gamma = Matrix3d::Identity();
    Vector3d beta = Vector3d::Zero();   //!< [m/s]
    Vector3d alpha = Vector3d::Zero();  //!< [m]
};

/** A motion with its derivatives by the biases. */
struct MotionDelta : Motion
{
    Matrix3d dtheta_dbg = Matrix3d::Zero();  //!< gamma(bg + d) = gamma Exp(dtheta_dbg d)
    Matrix3d dbeta_dba = Matrix3d::Zero(), dbeta_dbg = Matrix3d::Zero();
    Matrix3d dalpha_dba = Matrix3d::Zero(), dalpha_dbg = Matrix3d::Zero();
};

/** One knot of the chain: the (interpolated) sample there and the motion from t_k back to it. */
struct ImuKnot
{
    ImuSample sample;
    MotionDelta delta;
    /** Variance of the rotation from t_k back to here, of what the gyro hid [rad^2, of all axes].
     */
    double hidden = 0;
};

/** The motion between two scan ends as the IMU tells it, integrated from t_k backward to t_{k-1}.
 * The whole chain is kept, so that the motion at any point's time costs one partial step. */
class PreintegratedImu
{
 public:
    std::vector<ImuKnot> knots;  //!< knots.front() at t_k, then backward in time to t_{k-1}
    Vector3d bias_accel = Vector3d::Zero();  //!< biases that the chain was integrated with
    Vector3d bias_gyro = Vector3d::Zero();

    /** Specific force, in the world, of a body that is not accelerated [m/s^2]. Zero where the
     * samples are made up and feel no gravity. */
    Vector3d gravity = kGravityWorld;
    /** Density of the angular acceleration's white noise [rad^2/s^3] where nothing measures the
     * rate: then it is a state, the sample's rate minus bias_gyro. 0: the gyro measures it. */
    double rate_walk = 0;

    /** Covariance of (alpha, beta, theta) at t_{k-1} from the white noise; theta perturbs gamma on
     * the right. */
    Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
    /** Covariance of the change of (ba, bg) over the interval. */
    Eigen::Matrix<double, 6, 6> bias_walk_covariance = Eigen::Matrix<double, 6, 6>::Zero();

    Time end() const { return knots.front().sample.t; }             //!< t_k
    Time begin() const { return knots.back().sample.t; }            //!< t_{k-1}
    double duration() const { return toSeconds(end() - begin()); }  //!< [s]

    /** The chain for other biases, its knots corrected to first order. */
    PreintegratedImu correctedForBias(const Vector3d& accel, const Vector3d& gyro) const;

    /** The motion at time t with its derivatives, by one partial mid-point step from the next later
     * knot. `hint` is the index of the knot to try first, and receives the one used: a walk through
     * sorted times costs no search. Times outside [begin, end] are extrapolated from the nearest
     * interval. */
    MotionDelta at(Time t, std::size_t& hint) const;
    MotionDelta at(Time t) const;

    /** Share of a gap in rotation between t_k and t_{k-1} that is closed from t_k back to t. The
     * most probable path of white noise closes it in proportion to the variance that it gathers:
     * with time, but for stretches in which the gyro was at its limit. */
    double gapShare(Time t, std::size_t hint) const;

    /** The same without the derivatives. */
    Motion valueAt(Time t, std::size_t& hint) const;

 private:
    std::size_t intervalOf(Time t, std::size_t hint) const;
};

/** One backward mid-point step (paper, equation 8): the motion at `earlier` from the one at
 * `later`, with its derivatives by the biases. */
MotionDelta stepBackward(
    const MotionDelta& at_later, const ImuSample& later, const ImuSample& earlier,
    const Vector3d& bias_accel, const Vector3d& bias_gyro);

/** The same without the derivatives: for the many points of a scan. */
Motion stepBackwardValue(
    const Motion& at_later, const ImuSample& later, const ImuSample& earlier,
    const Vector3d& bias_accel, const Vector3d& bias_gyro);

/** First-order correction of a motion for biases other than those it was integrated with. */
MotionDelta correctedForBias(
    const MotionDelta& delta, const Vector3d& dbias_accel, const Vector3d& dbias_gyro);

/** Linear interpolation between two samples. */
ImuSample interpolate(const ImuSample& a, const ImuSample& b, Time t);
}  // namespace taut
