#include "taut/inspection/RotationAlignment.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr int kParameters = 7;  // offset, rotation, bias
constexpr int kIterations = 15;
constexpr std::size_t kParts = 10;       // of the jackknife
constexpr double kSlope = 1e-3;          // [s] step of the derivative by the offset
constexpr double kRotationSigma = 0.5;   // [rad] prior about R_expected: only where nothing is seen
constexpr double kSmallestNoise = 1e-5;  // [rad] of a turn
constexpr double kWahbaPrior = 1e-3;     // share of the weight of R_expected

using Vector7 = Eigen::Matrix<double, kParameters, 1>;
using Matrix7 = Eigen::Matrix<double, kParameters, kParameters>;
using Rows = Eigen::Matrix<double, 3, kParameters>;

/** The rotation R that best takes the LiDAR's turns to the gyro's (Wahba's problem). */
Matrix3d bestRotation(const Matrix3d& correlation, const Matrix3d& R_expected)
{
    const Matrix3d B = correlation + kWahbaPrior * correlation.norm() * R_expected;
    const Eigen::JacobiSVD<Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double det = (svd.matrixU() * svd.matrixV().transpose()).determinant();
    return svd.matrixU() * Vector3d(1, 1, det).asDiagonal() * svd.matrixV().transpose();
}

class Fit
{
 public:
    Fit(const LidarTurns& turns, const GyroRotation& gyro, const Matrix3d& R_expected,
        const AlignmentConfig& config)
        : R(R_expected), turns_(turns), gyro_(gyro), R_expected_(R_expected), config_(config)
    {
    }

    /** Takes the offset with the least left over, and its rotation. */
    void search()
    {
        double least = std::numeric_limits<double>::infinity();
        const int steps = static_cast<int>(std::ceil(config_.max_offset / config_.step));
        for (int i = -steps; i <= steps; i++)
        {
            const double at = i * config_.step;
            Matrix3d correlation = Matrix3d::Zero();
            for (const LidarTurn& l : turns_) correlation += gyroTurn(l, at) * l.turn.transpose();
            const Matrix3d R_at = bestRotation(correlation, R_expected_);
            double left = 0;
            // Sums of norms, not of squares: a few wrong turns shall not decide.
            for (const LidarTurn& l : turns_) left += (gyroTurn(l, at) - R_at * l.turn).norm();
            if (left >= least) continue;
            least = left;
            offset = at;
            R = R_at;
        }
    }

    /** Fits all parameters to the turns outside [skip_begin, skip_end). */
    void refine(std::size_t skip_begin, std::size_t skip_end)
    {
        for (int i = 0; i < kIterations; i++)
        {
            const double scale = spread(skip_begin, skip_end);
            information = priorInformation();
            Vector7 gradient = priorGradient();
            for (std::size_t k = 0; k < turns_.size(); k++)
            {
                if (k >= skip_begin && k < skip_end) continue;
                const Vector3d r = residual(turns_[k]);
                const double x = r.norm() / (3 * scale);
                const double weight = 1 / ((1 + x * x) * scale * scale);  // Cauchy's
                const Rows J = jacobian(turns_[k]);
                information += weight * J.transpose() * J;
                gradient += weight * J.transpose() * r;
            }
            const Vector7 step = -information.ldlt().solve(gradient);
            offset = std::clamp(
                offset + std::clamp(step[0], -config_.step, config_.step), -config_.max_offset,
                config_.max_offset);
            R = normalizedRotation(R * expSO3(step.segment<3>(1)));
            bias += step.segment<3>(4);
            if (std::abs(step[0]) < 1e-7 && step.tail<6>().norm() < 1e-7) break;
        }
    }

    Vector3d residual(const LidarTurn& l) const
    {
        return gyroTurn(l, offset) - R * l.turn - bias * toSeconds(l.end - l.begin);
    }

    /** Standard deviation of a residual's component, by the median. */
    double spread(std::size_t skip_begin, std::size_t skip_end) const
    {
        std::vector<double> norms;
        for (std::size_t k = 0; k < turns_.size(); k++)
            if (k < skip_begin || k >= skip_end) norms.push_back(residual(turns_[k]).norm());
        const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
        std::nth_element(norms.begin(), middle, norms.end());
        return std::max(kSmallestNoise, *middle / 1.538);  // median of chi with 3 dof
    }

    double offset = 0;
    Matrix3d R;
    Vector3d bias = Vector3d::Zero();
    Matrix7 information;

 private:
    Vector3d gyroTurn(const LidarTurn& l, double at) const
    {
        const Duration d = fromSeconds(at);
        return gyro_.between(l.begin + d, l.end + d).value_or(Vector3d::Zero());
    }

    Rows jacobian(const LidarTurn& l) const
    {
        Rows J;
        J.col(0) = (gyroTurn(l, offset + kSlope) - gyroTurn(l, offset - kSlope)) / (2 * kSlope);
        J.middleCols<3>(1) = R * hat(l.turn);
        J.middleCols<3>(4) = -toSeconds(l.end - l.begin) * Matrix3d::Identity();
        return J;
    }

    Matrix7 priorInformation() const
    {
        Vector7 sigma;
        sigma << 10 * config_.max_offset, Vector3d::Constant(kRotationSigma),
            Vector3d::Constant(config_.bias_sigma);
        return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    }

    Vector7 priorGradient() const
    {
        Vector7 g = Vector7::Zero();
        g.segment<3>(1) = logSO3(R_expected_.transpose() * R) / (kRotationSigma * kRotationSigma);
        g.segment<3>(4) = bias / (config_.bias_sigma * config_.bias_sigma);
        return g;
    }

    const LidarTurns& turns_;
    const GyroRotation& gyro_;
    const Matrix3d R_expected_;
    const AlignmentConfig& config_;
};

/** Turns that the gyro covers wherever the search looks, and without long gaps. */
LidarTurns coveredTurns(
    const LidarTurns& turns, const GyroRotation& gyro, const AlignmentConfig& config)
{
    const Duration margin = fromSeconds(config.max_offset + 2 * kSlope);
    LidarTurns covered;
    for (const LidarTurn& l : turns)
        if (gyro.between(l.begin - margin, l.end + margin) &&
            toSeconds(gyro.longestGap(l.begin, l.end)) <= config.max_gap)
            covered.push_back(l);
    return covered;
}

/** Adds what the jackknife says to the formal uncertainty. */
void addJackknife(const Fit& all, const LidarTurns& turns, RotationAlignment& result)
{
    Eigen::Vector4d variance = Eigen::Vector4d::Zero();
    for (std::size_t part = 0; part < kParts; part++)
    {
        Fit without = all;
        without.refine(part * turns.size() / kParts, (part + 1) * turns.size() / kParts);
        Eigen::Vector4d d;
        d << without.offset - all.offset, logSO3(all.R.transpose() * without.R);
        variance += d.cwiseAbs2() * (kParts - 1.0) / kParts;
    }
    result.clock_sigma = std::max(result.clock_sigma, std::sqrt(variance[0]));
    for (int i = 0; i < 3; i++)
    {
        const double grow = std::sqrt(std::max(1.0, variance[i + 1] / result.R_covariance(i, i)));
        result.R_covariance.row(i) *= grow;
        result.R_covariance.col(i) *= grow;
    }
}
}  // namespace

std::optional<RotationAlignment> alignRotations(
    const LidarTurns& all_turns, const GyroRotation& gyro, const Matrix3d& R_expected,
    const AlignmentConfig& config)
{
    const LidarTurns turns = coveredTurns(all_turns, gyro, config);
    if (turns.size() < config.min_turns) return {};
    Fit fit(turns, gyro, R_expected, config);
    fit.search();
    fit.refine(0, 0);

    RotationAlignment result;
    result.turns = turns.size();
    result.clock_offset = fit.offset;
    result.R_imu_lidar = fit.R;
    result.bias = fit.bias;
    const Matrix7 covariance = fit.information.inverse();
    result.clock_sigma = std::sqrt(covariance(0, 0));
    result.R_covariance = covariance.block<3, 3>(1, 1);
    addJackknife(fit, turns, result);

    double left = 0, seen = 0, rate = 0;
    for (const LidarTurn& l : turns)
    {
        const Vector3d r = fit.residual(l), turned = r + fit.R * l.turn;
        left += r.squaredNorm();
        seen += turned.squaredNorm();
        rate += turned.squaredNorm() / std::pow(toSeconds(l.end - l.begin), 2);
    }
    result.unexplained = seen > 0 ? std::sqrt(std::min(1.0, left / seen)) : 1;
    result.gyro_rate = std::sqrt(rate / static_cast<double>(turns.size()));
    return result;
}
}  // namespace taut
