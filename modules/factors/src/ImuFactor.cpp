#include "taut/factors/ImuFactor.h"

namespace taut
{
namespace
{
constexpr int kP = NavState::kPosition, kV = NavState::kVelocity, kTheta = NavState::kRotation,
              kBa = NavState::kBiasAccel, kBg = NavState::kBiasGyro;

MotionDelta startOf(const PreintegratedImu& imu, const NavState& current)
{
    return correctedForBias(
        imu.knots.back().delta, current.bias_accel - imu.bias_accel,
        current.bias_gyro - imu.bias_gyro);
}
}  // namespace

ImuResidual linearizeImu(
    const PreintegratedImu& imu, const NavState& previous, const NavState& current)
{
    const double dt = imu.duration();
    const MotionDelta start = startOf(imu, current);
    const Matrix3d Rt = current.T_world_imu.R.transpose();
    const Matrix3d I = Matrix3d::Identity();
    const Vector3d dp = Rt * (current.T_world_imu.p - current.v_world * dt -
                              0.5 * imu.gravity * dt * dt - previous.T_world_imu.p);
    const Vector3d dv = Rt * (current.v_world + imu.gravity * dt - previous.v_world);
    const Matrix3d gap = Rt * previous.T_world_imu.R * start.gamma.transpose();

    ImuResidual f;
    f.residual.segment<3>(kP) = dp + start.alpha;
    f.residual.segment<3>(kV) = dv + start.beta;
    f.residual.segment<3>(kTheta) = logSO3(gap);
    f.residual.segment<3>(kBa) = current.bias_accel - previous.bias_accel;
    f.residual.segment<3>(kBg) = current.bias_gyro - previous.bias_gyro;

    const Matrix3d by_gap = inverseRightJacobianSO3(Vector3d(f.residual.segment<3>(kTheta)));
    f.d_previous.setZero();
    f.d_previous.block<3, 3>(kP, kP) = -Rt;
    f.d_previous.block<3, 3>(kV, kV) = -Rt;
    f.d_previous.block<3, 3>(kTheta, kTheta) = by_gap * start.gamma;
    f.d_previous.block<3, 3>(kBa, kBa) = -I;
    f.d_previous.block<3, 3>(kBg, kBg) = -I;

    f.d_current.setZero();
    f.d_current.block<3, 3>(kP, kP) = Rt;
    f.d_current.block<3, 3>(kP, kV) = -Rt * dt;
    f.d_current.block<3, 3>(kP, kTheta) = hat(dp);
    f.d_current.block<3, 3>(kP, kBa) = start.dalpha_dba;
    f.d_current.block<3, 3>(kP, kBg) = start.dalpha_dbg;
    f.d_current.block<3, 3>(kV, kV) = Rt;
    f.d_current.block<3, 3>(kV, kTheta) = hat(dv);
    f.d_current.block<3, 3>(kV, kBa) = start.dbeta_dba;
    f.d_current.block<3, 3>(kV, kBg) = start.dbeta_dbg;
    f.d_current.block<3, 3>(kTheta, kTheta) = -by_gap * gap.transpose();
    f.d_current.block<3, 3>(kTheta, kBg) = -by_gap * start.gamma * start.dtheta_dbg;
    f.d_current.block<3, 3>(kBa, kBa) = I;
    f.d_current.block<3, 3>(kBg, kBg) = I;
    return f;
}

NavState::Vector imuResidual(
    const PreintegratedImu& imu, const NavState& previous, const NavState& current)
{
    return linearizeImu(imu, previous, current).residual;
}

NavState::Matrix imuCovariance(const PreintegratedImu& imu)
{
    NavState::Matrix P = NavState::Matrix::Zero();
    // (alpha, beta, theta) of the chain stand in the rows p, v, theta of the residual. The error of
    // theta perturbs gamma on the right; in the residual Log(R^T R_{k-1} gamma^T) it appears turned
    // by gamma, with the opposite sign.
    Eigen::Matrix<double, 9, 9> turn = Eigen::Matrix<double, 9, 9>::Identity();
    turn.block<3, 3>(6, 6) = -imu.knots.back().delta.gamma;
    P.topLeftCorner<9, 9>() = turn * imu.covariance * turn.transpose();
    P.bottomRightCorner<6, 6>() = imu.bias_walk_covariance;
    // A rate that walks by w(s) ends at another one, which moves the bias by -int w, and the
    // rotation, seen from that rate, by int s w: correlated by -q Delta^2 / 2.
    const Matrix3d both = Matrix3d::Identity() * (-0.5 * imu.rate_walk * square(imu.duration()));
    P.block<3, 3>(kTheta, kBg) = P.block<3, 3>(kBg, kTheta) = both;
    return P;
}

NavState predict(const PreintegratedImu& imu, const NavState& previous)
{
    const double dt = imu.duration();
    const MotionDelta& start = imu.knots.back().delta;
    NavState x = previous;
    x.t = imu.end();
    x.T_world_imu.R = normalizedRotation(previous.T_world_imu.R * start.gamma.transpose());
    x.v_world = previous.v_world - imu.gravity * dt - x.T_world_imu.R * start.beta;
    x.T_world_imu.p = previous.T_world_imu.p + x.v_world * dt + 0.5 * imu.gravity * dt * dt -
                      x.T_world_imu.R * start.alpha;
    return x;
}
}  // namespace taut
