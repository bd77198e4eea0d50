#include "chain.h"

namespace taut
{
PreintegratedImu startChain(
    const ImuSample& at_end, const Vector3d& bias_accel, const Vector3d& bias_gyro)
{
    PreintegratedImu chain;
    chain.bias_accel = bias_accel;
    chain.bias_gyro = bias_gyro;
    chain.knots.push_back({at_end, {}, 0});
    return chain;
}

void extendBackward(PreintegratedImu& chain, const ImuSample& earlier, const StepNoise& noise)
{
    const ImuKnot later = chain.knots.back();
    const double dt = toSeconds(later.sample.t - earlier.t);
    const MotionDelta delta =
        stepBackward(later.delta, later.sample, earlier, chain.bias_accel, chain.bias_gyro);

    const Vector3d rate = 0.5 * (later.sample.gyro + earlier.gyro) - chain.bias_gyro;
    const Matrix3d turned_later = later.delta.gamma * hat(later.sample.accel - chain.bias_accel);
    const Matrix3d turned_earlier = delta.gamma * hat(earlier.accel - chain.bias_accel);

    // Errors of (alpha, beta, theta) at the earlier time: F times those at the later time plus G
    // times the noise (na, nw) of the step.
    const Matrix3d I = Matrix3d::Identity();
    const Matrix3d theta_theta = expSO3(rate * dt);
    const Matrix3d theta_noise = rightJacobianSO3(-rate * dt) * dt;
    const Matrix3d beta_theta = 0.5 * dt * (turned_later + turned_earlier * theta_theta);
    const Matrix3d beta_accel = 0.5 * dt * (later.delta.gamma + delta.gamma);
    const Matrix3d beta_gyro = 0.5 * dt * turned_earlier * theta_noise;

    Eigen::Matrix<double, 9, 9> F = Eigen::Matrix<double, 9, 9>::Identity();
    F.block<3, 3>(0, 3) = -dt * I;
    F.block<3, 3>(0, 6) = -0.5 * dt * beta_theta;
    F.block<3, 3>(3, 6) = beta_theta;
    F.block<3, 3>(6, 6) = theta_theta;

    Eigen::Matrix<double, 9, 6> G = Eigen::Matrix<double, 9, 6>::Zero();
    G.block<3, 3>(0, 0) = -0.5 * dt * beta_accel;
    G.block<3, 3>(0, 3) = -0.5 * dt * beta_gyro;
    G.block<3, 3>(3, 0) = beta_accel;
    G.block<3, 3>(3, 3) = beta_gyro;
    G.block<3, 3>(6, 3) = theta_noise;
    G.leftCols<3>() *= noise.accel / std::sqrt(dt);
    G.rightCols<3>() *= noise.gyro / std::sqrt(dt);

    chain.covariance = F * chain.covariance * F.transpose() + G * G.transpose();
    // White noise is not constant during the step: a third of dt^3, of which its mean explains a
    // quarter. Without it one long step would tie position and velocity to each other.
    chain.covariance.diagonal().head<3>().array() += noise.accel * noise.accel * dt * dt * dt / 12;
    chain.knots.push_back({earlier, delta, later.hidden + 3 * square(noise.gyro_hidden) * dt});
}
}  // namespace taut
