#include "taut/odometry/ScanProblem.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace taut
{
namespace
{
constexpr int kN = NavState::kSize;

NavState::Matrix symmetricInverse(const NavState::Matrix& m)
{
    const NavState::Matrix inverse =
        NavState::Matrix(0.5 * (m + m.transpose())).ldlt().solve(NavState::Matrix::Identity());
    return 0.5 * (inverse + inverse.transpose());
}
/** Takes away what the LiDAR says of a direction of the position that hardly any of its matches
 * show: normals that err by a degree or two would say as much of a direction that nothing shows,
 * and thousands of them together would be believed. */
void leaveOpen(const EstimationConfig& config, ProblemMatrix& hessian, ProblemVector& gradient)
{
    if (!(config.open_share > 0)) return;
    const Matrix3d position =
        hessian.block<3, 3>(kN + NavState::kPosition, kN + NavState::kPosition);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(position);
    const double all = eigen.eigenvalues().sum();
    if (!(all > 0)) return;
    Matrix3d keep = Matrix3d::Zero();
    for (int i = 0; i < 3; i++)
    {
        const double share = eigen.eigenvalues()[i] / all;
        const double kept = std::clamp(
            (share - config.open_share) / (config.shown_share - config.open_share), 0.0, 1.0);
        keep += kept * eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    }
    for (const int at : {NavState::kPosition, kN + NavState::kPosition})
    {
        hessian.middleRows<3>(at) = (keep * hessian.middleRows<3>(at)).eval();
        hessian.middleCols<3>(at) = (hessian.middleCols<3>(at) * keep).eval();
        gradient.segment<3>(at) = (keep * gradient.segment<3>(at)).eval();
    }
}
}  // namespace

Matrix3d NavPrior::covarianceOf(int part) const
{
    return symmetricInverse(information).block<3, 3>(part, part);
}

void NavPrior::forget(int part, const Matrix3d& covariance)
{
    NavState::Matrix P = symmetricInverse(information);
    P.middleRows<3>(part).setZero();
    P.middleCols<3>(part).setZero();
    P.block<3, 3>(part, part) = covariance;
    information = symmetricInverse(P);
}

ScanProblem::ScanProblem(
    const NavPrior& previous, const PreintegratedImu& imu, const LidarFactor& lidar,
    SweepPath& path, const EstimationConfig& config)
    : prior_(previous), imu_(imu), lidar_(lidar), path_(path), config_(config)
{
    previous_ = saved_previous_ = previous.state;
    current_ = saved_current_ = predict(imu, previous.state);

    // The previous state's uncertainty, carried through the residual.
    const ImuResidual f = linearizeImu(imu, previous_, current_);
    const NavState::Matrix of_imu = imuCovariance(imu);
    const NavState::Matrix of_both =
        of_imu + f.d_previous * symmetricInverse(previous.information) * f.d_previous.transpose();
    imu_information_ = symmetricInverse(released() ? of_imu : of_both);

    const NavState::Matrix to_current = f.d_current.inverse();
    predicted_ = to_current * of_both * to_current.transpose();
}

int ScanProblem::dimension() const
{
    return released() ? 2 * kN : kN;
}

LidarFactor::PoseCovariance ScanProblem::predictedPoseCovariance() const
{
    constexpr std::array<int, 2> parts{NavState::kPosition, NavState::kRotation};
    LidarFactor::PoseCovariance pose;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            pose.block<3, 3>(3 * i, 3 * j) = predicted_.block<3, 3>(parts[i], parts[j]);
    return pose;
}

double ScanProblem::addPrior(ProblemMatrix& H, ProblemVector& g) const
{
    const NavState::Vector e = previous_.localFrom(prior_.state);
    NavState::Matrix J = NavState::Matrix::Identity();
    J.block<3, 3>(NavState::kRotation, NavState::kRotation) =
        inverseRightJacobianSO3(Vector3d(e.segment<3>(NavState::kRotation)));
    const NavState::Matrix WJ = prior_.information * J;
    const NavState::Vector We = prior_.information * e;
    H.topLeftCorner<kN, kN>() += J.transpose() * WJ;
    g.head<kN>() += J.transpose() * We;
    return 0.5 * e.dot(We);
}

double ScanProblem::addImu(ProblemMatrix& H, ProblemVector& g) const
{
    const ImuResidual f = linearizeImu(imu_, previous_, current_);
    const NavState::Matrix W_current = imu_information_ * f.d_current;
    const NavState::Vector Wr = imu_information_ * f.residual;
    H.bottomRightCorner<kN, kN>() += f.d_current.transpose() * W_current;
    g.tail<kN>() += f.d_current.transpose() * Wr;
    if (released())
    {
        H.topLeftCorner<kN, kN>() += f.d_previous.transpose() * imu_information_ * f.d_previous;
        const NavState::Matrix cross = f.d_previous.transpose() * W_current;
        H.topRightCorner<kN, kN>() += cross;
        H.bottomLeftCorner<kN, kN>() += cross.transpose();
        g.head<kN>() += f.d_previous.transpose() * Wr;
    }
    return 0.5 * f.residual.dot(Wr);
}

double ScanProblem::addBiasPrior(ProblemMatrix& H, ProblemVector& g) const
{
    const double share = imu_.duration() / config_.bias_time;
    double cost = 0;
    const auto add = [&](int at, const Vector3d& bias, double sigma)
    {
        const double w = share / (sigma * sigma);
        const int row = dimension() - kN + at;
        H.diagonal().segment<3>(row).array() += w;
        g.segment<3>(row) += w * bias;
        cost += 0.5 * w * bias.squaredNorm();
    };
    add(NavState::kBiasAccel, current_.bias_accel, config_.accel_bias_sigma);
    // Where no gyro measures it, the rate stands in the place of its bias.
    if (imu_.rate_walk == 0) add(NavState::kBiasGyro, current_.bias_gyro, config_.gyro_bias_sigma);
    return cost;
}

double ScanProblem::addRest(ProblemMatrix& H, ProblemVector& g) const
{
    double cost = 0;
    const auto add = [&](int part, const Vector3d& e, const Matrix3d& J, double sigma)
    {
        const double w = 1 / square(sigma);
        const int at = dimension() - kN + part;
        H.block<3, 3>(at, at) += w * J.transpose() * J;
        g.segment<3>(at) += w * J.transpose() * e;
        cost += 0.5 * w * e.squaredNorm();
    };
    const Pose& pose = current_.T_world_imu;
    const Vector3d turned = logSO3(motion_prior_.T_world_imu.R.transpose() * pose.R);
    add(NavState::kPosition, pose.p - motion_prior_.T_world_imu.p, Matrix3d::Identity(),
        motion_prior_.position_sigma);
    add(NavState::kVelocity, current_.v_world - motion_prior_.v_world, Matrix3d::Identity(),
        motion_prior_.velocity_sigma);
    add(NavState::kRotation, turned, inverseRightJacobianSO3(turned), motion_prior_.rotation_sigma);
    return cost;
}

double ScanProblem::addAllButLidar(ProblemMatrix& H, ProblemVector& g) const
{
    double cost = addImu(H, g) + addBiasPrior(H, g) + addRest(H, g);
    if (released()) cost += addPrior(H, g);
    return cost;
}

double ScanProblem::linearize(ProblemMatrix& hessian, ProblemVector& gradient)
{
    hessian.setZero(dimension(), dimension());
    gradient.setZero(dimension());
    double cost = addAllButLidar(hessian, gradient);

    lidar_hessian_.setZero(2 * kN, 2 * kN);
    ProblemVector lidar_gradient = ProblemVector::Zero(2 * kN);
    if (use_lidar_) cost += lidar_.linearize(path_, balance_, lidar_hessian_, lidar_gradient);
    leaveOpen(config_, lidar_hessian_, lidar_gradient);
    hessian += lidar_hessian_.bottomRightCorner(dimension(), dimension());
    gradient += lidar_gradient.tail(dimension());
    hessian_ = hessian;
    linearized_ = true;
    return cost;
}

void ScanProblem::relinearize()
{
    if (linearized_) return;
    ProblemMatrix H;
    ProblemVector g;
    linearize(H, g);
}

double ScanProblem::cost()
{
    ProblemMatrix H = ProblemMatrix::Zero(dimension(), dimension());
    ProblemVector g = ProblemVector::Zero(dimension());
    const double sum = addAllButLidar(H, g);
    return use_lidar_ ? sum + lidar_.cost(path_, balance_) : sum;
}

void ScanProblem::retract(const ProblemVector& delta)
{
    if (released()) previous_ = previous_.retract(delta.head<kN>());
    current_ = current_.retract(delta.tail<kN>());
    linearized_ = false;
    path_.setStates(previous_, current_);
}

void ScanProblem::startFrom(const NavState& current)
{
    previous_ = prior_.state;
    current_ = current;
    linearized_ = false;
    path_.setStates(previous_, current_);
}

void ScanProblem::save()
{
    saved_previous_ = previous_;
    saved_current_ = current_;
}

void ScanProblem::restore()
{
    previous_ = saved_previous_;
    current_ = saved_current_;
    linearized_ = false;
    path_.setStates(previous_, current_);
}

ProblemMatrix ScanProblem::chartJacobian(const ProblemVector& z) const
{
    ProblemMatrix J = ProblemMatrix::Identity(dimension(), dimension());
    for (int at = NavState::kRotation; at < dimension(); at += kN)
        J.block<3, 3>(at, at) = rightJacobianSO3(Vector3d(z.segment<3>(at)));
    return J;
}

ProblemVector ScanProblem::maxStep() const
{
    NavState::Vector one;
    one << Vector3d::Constant(config_.max_step_position),
        Vector3d::Constant(config_.max_step_velocity),
        Vector3d::Constant(config_.max_step_rotation),
        Vector3d::Constant(config_.max_step_bias_accel),
        Vector3d::Constant(
            imu_.rate_walk > 0 ? config_.max_step_rotation / imu_.duration()
                               : config_.max_step_bias_gyro);
    ProblemVector all(dimension());
    if (released())
        all << one, one;
    else
        all = one;
    return all;
}

NavState::Matrix ScanProblem::lidarInformation() const
{
    return lidar_hessian_.bottomRightCorner<kN, kN>();
}

NavState::Matrix ScanProblem::marginalInformation() const
{
    if (!released()) return hessian_;
    const NavState::Matrix to_previous = hessian_.bottomLeftCorner<kN, kN>();
    const NavState::Matrix previous = hessian_.topLeftCorner<kN, kN>();
    const NavState::Matrix current = hessian_.bottomRightCorner<kN, kN>();
    const NavState::Matrix marginal =
        current - to_previous * previous.ldlt().solve(to_previous.transpose());
    return 0.5 * (marginal + marginal.transpose());
}
}  // namespace taut
