#include "taut/factors/SweepPath.h"

#include <atomic>

namespace taut
{
namespace
{
const std::map<std::string, Undistortion>& modeNames()
{
    static const std::map<std::string, Undistortion> names{
        {"none", Undistortion::None},         {"rotation", Undistortion::Rotation},
        {"imu", Undistortion::Imu},           {"iterated-imu", Undistortion::IteratedImu},
        {"iterated", Undistortion::Iterated}, {"bridge", Undistortion::Bridge}};
    return names;
}

// Columns of the jacobian: the previous state first, then the current one.
constexpr int kPrevious = 0, kCurrent = NavState::kSize;
constexpr int kP0 = kPrevious + NavState::kPosition, kV0 = kPrevious + NavState::kVelocity,
              kTheta0 = kPrevious + NavState::kRotation, kBg0 = kPrevious + NavState::kBiasGyro;
constexpr int kP = kCurrent + NavState::kPosition, kV = kCurrent + NavState::kVelocity,
              kTheta = kCurrent + NavState::kRotation, kBa = kCurrent + NavState::kBiasAccel,
              kBg = kCurrent + NavState::kBiasGyro;
constexpr int kRows = 3;
}  // namespace

bool isIterated(Undistortion mode)
{
    return mode == Undistortion::IteratedImu || mode == Undistortion::Iterated ||
           mode == Undistortion::Bridge;
}

void declareUndistortion(ConfigSection& section, Undistortion& mode)
{
    section.choice<Undistortion>("undistortion", mode, modeNames(), "how points are undistorted");
}

const char* nameOf(Undistortion mode)
{
    for (const auto& [name, value] : modeNames())
        if (value == mode) return name.c_str();
    return "?";
}

SweepPath::SweepPath(
    Undistortion mode, const PreintegratedImu& imu, const NavState& prior_previous,
    const NavState& prior_current)
    : mode_(mode), imu_(imu), chain_(imu), prior_current_(prior_current), duration_(imu.duration())
{
    setStates(prior_previous, prior_current);
}

bool SweepPath::rateIsState() const
{
    return mode_ == Undistortion::Bridge && imu_.rate_walk > 0;
}

Vector3d SweepPath::aprioriPosition(double d, const Motion& motion) const
{
    // The one-pass modes keep the a-priori velocity and direction of gravity.
    const NavState& x = isIterated(mode_) ? current_ : prior_current_;
    return x.T_world_imu.R.transpose() * (-x.v_world * d - 0.5 * imu_.gravity * d * d) +
           motion.alpha;
}

void SweepPath::setStates(const NavState& previous, const NavState& current)
{
    static std::atomic<std::uint64_t> revisions{0};
    revision_ = ++revisions;
    previous_ = previous;
    current_ = current;
    if (!isIterated(mode_)) return;

    const Matrix3d Rt = current.T_world_imu.R.transpose();
    if (current.bias_accel != chain_.bias_accel || current.bias_gyro != chain_.bias_gyro)
        chain_ = imu_.correctedForBias(current.bias_accel, current.bias_gyro);
    start_ = chain_.knots.back().delta;
    apriori_start_ = {start_.gamma, aprioriPosition(duration_, start_)};
    const Vector3d start_in_k = Rt * (previous.T_world_imu.p - current.T_world_imu.p);

    gap_rotation_ = Rt * previous.T_world_imu.R * start_.gamma.transpose();
    gap_log_ = logSO3(gap_rotation_);
    gap_rate_ = start_.gamma * (current.bias_gyro - previous.bias_gyro);
    gap_translation_ = start_in_k - gap_rotation_ * apriori_start_.p;
    gap_position_ = start_in_k - apriori_start_.p;
    gap_velocity_ =
        Rt * (previous.v_world - current.v_world - imu_.gravity * duration_) - start_.beta;
}

SweepPath::Local SweepPath::localAt(Time t, const Motion& motion, std::size_t hint) const
{
    Local at;
    at.d = toSeconds(imu_.end() - t);
    at.mu = at.d / duration_;
    if (mode_ == Undistortion::None) return at;

    at.apriori.R = motion.gamma;
    if (mode_ != Undistortion::Rotation) at.apriori.p = aprioriPosition(at.d, motion);

    at.corrected = at.apriori;
    if (mode_ == Undistortion::Iterated || mode_ == Undistortion::Bridge)
    {
        at.turned = imu_.gapShare(t, hint);
        at.turn = at.turned * gap_log_;
        if (rateIsState())
        {
            // As the position: the cubic that has the rates of both ends, too.
            at.turned = square(at.mu) * (3 - 2 * at.mu);
            at.by_rate = square(at.mu) * (1 - at.mu) * duration_;
            at.turn = at.turned * gap_log_ + at.by_rate * gap_rate_;
        }
        at.correction = expSO3(at.turn);
        at.corrected.R = at.correction * at.apriori.R;
    }
    const double mu2 = at.mu * at.mu, mu3 = mu2 * at.mu;
    if (mode_ == Undistortion::Iterated)
        at.corrected.p = at.correction * at.apriori.p + at.mu * gap_translation_;
    if (mode_ == Undistortion::Bridge)
        at.corrected.p = at.apriori.p + (3 * mu2 - 2 * mu3) * gap_position_ +
                         (mu2 - mu3) * duration_ * gap_velocity_;
    return at;
}

Pose SweepPath::poseAt(Time t, std::size_t& hint) const
{
    const Motion motion = chain_.valueAt(t, hint);
    return current_.T_world_imu * localAt(t, motion, hint).corrected;
}

Pose SweepPath::poseAt(Time t, std::size_t& hint, PathJacobian& jacobian) const
{
    const MotionDelta motion = chain_.at(t, hint);
    const Local at = localAt(t, motion, hint);
    jacobian.setZero();
    rotationJacobian(at, motion, jacobian);
    positionJacobian(at, motion, jacobian);
    return current_.T_world_imu * at.corrected;
}

void SweepPath::rotationJacobian(const Local& at, const MotionDelta& motion, PathJacobian& J) const
{
    J.block<3, 3>(kRows, kTheta) = at.corrected.R.transpose();
    if (!isIterated(mode_)) return;
    J.block<3, 3>(kRows, kBg) = motion.dtheta_dbg;
    if (mode_ == Undistortion::IteratedImu) return;

    // R_D <- R_D Exp(d_D) moves the correction by dR_j <- dR_j Exp(e), e = mu Jr(mu phi) Jr^-1(phi)
    // d_D.
    const Matrix3d spread = motion.gamma.transpose() * at.turned * rightJacobianSO3(at.turn) *
                            inverseRightJacobianSO3(gap_log_);
    J.block<3, 3>(kRows, kTheta) -= spread * gap_rotation_.transpose();
    J.block<3, 3>(kRows, kTheta0) = spread * start_.gamma;
    J.block<3, 3>(kRows, kBg) -= spread * start_.gamma * start_.dtheta_dbg;
    if (!rateIsState()) return;
    const Matrix3d by_rate =
        motion.gamma.transpose() * at.by_rate * rightJacobianSO3(at.turn) * start_.gamma;
    const Vector3d change = current_.bias_gyro - previous_.bias_gyro;
    J.block<3, 3>(kRows, kBg) += by_rate * (Matrix3d::Identity() - hat(change) * start_.dtheta_dbg);
    J.block<3, 3>(kRows, kBg0) -= by_rate;
}

void SweepPath::positionJacobian(const Local& at, const MotionDelta& motion, PathJacobian& J) const
{
    const Matrix3d& R = current_.T_world_imu.R;
    const Matrix3d Rt = R.transpose();
    const Matrix3d I = Matrix3d::Identity();
    J.block<3, 3>(0, kP) = I;
    J.block<3, 3>(0, kTheta) = -R * hat(at.corrected.p);
    if (!isIterated(mode_)) return;

    // Derivatives of pcheck_j in the frame at t_k, gathered here and turned to the world at the
    // end.
    Eigen::Matrix<double, 3, 2 * NavState::kSize> C;
    C.setZero();
    // pbar(d) = R^T (-v d - 1/2 g d^2) + alpha, times a factor, added to C.
    const auto addApriori = [&](const Matrix3d& factor, double d, const MotionDelta& m)
    {
        const Vector3d fall = Rt * (-current_.v_world * d - 0.5 * imu_.gravity * d * d);
        C.block<3, 3>(0, kTheta) += factor * hat(fall);
        C.block<3, 3>(0, kV) -= factor * Rt * d;
        C.block<3, 3>(0, kBa) += factor * m.dalpha_dba;
        C.block<3, 3>(0, kBg) += factor * m.dalpha_dbg;
    };
    // R^T (p_{k-1} - p_k), times a factor.
    const auto addStart = [&](double factor)
    {
        const Vector3d start = Rt * (previous_.T_world_imu.p - current_.T_world_imu.p);
        C.block<3, 3>(0, kTheta) += factor * hat(start);
        C.block<3, 3>(0, kP0) += factor * Rt;
        C.block<3, 3>(0, kP) -= factor * Rt;
    };

    const double mu2 = at.mu * at.mu, mu3 = mu2 * at.mu;
    addApriori(mode_ == Undistortion::Iterated ? at.correction : I, at.d, motion);
    if (mode_ == Undistortion::Iterated)
    {
        const Matrix3d turn = -at.correction * hat(at.apriori.p) * at.turned *
                              rightJacobianSO3(at.turned * gap_log_) *
                              inverseRightJacobianSO3(gap_log_);
        const Matrix3d of_gap = turn + at.mu * gap_rotation_ * hat(apriori_start_.p);
        C.block<3, 3>(0, kTheta) -= of_gap * gap_rotation_.transpose();
        C.block<3, 3>(0, kTheta0) += of_gap * start_.gamma;
        C.block<3, 3>(0, kBg) -= of_gap * start_.gamma * start_.dtheta_dbg;
        addStart(at.mu);
        addApriori(-at.mu * gap_rotation_, duration_, start_);
    }
    if (mode_ == Undistortion::Bridge)
    {
        const double close_position = 3 * mu2 - 2 * mu3;
        const double close_velocity = (mu2 - mu3) * duration_;
        addStart(close_position);
        addApriori(-close_position * I, duration_, start_);
        const Vector3d dv = Rt * (previous_.v_world - current_.v_world - imu_.gravity * duration_);
        C.block<3, 3>(0, kTheta) += close_velocity * hat(dv);
        C.block<3, 3>(0, kV0) += close_velocity * Rt;
        C.block<3, 3>(0, kV) -= close_velocity * Rt;
        C.block<3, 3>(0, kBa) -= close_velocity * start_.dbeta_dba;
        C.block<3, 3>(0, kBg) -= close_velocity * start_.dbeta_dbg;
    }
    J.topRows<3>() += R * C;
}
}  // namespace taut
