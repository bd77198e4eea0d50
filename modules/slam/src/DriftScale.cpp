#include "taut/slam/DriftScale.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kLargest = 100;         // and its inverse the least
constexpr int kSteps = 120;              // of the grid, equal in the logarithm
constexpr double kGuessDeviation = 3.0;  // of the logarithm: a factor of 20
constexpr double kMostEvidence = 6;      // gaps that all gaps count as

/** A gap in the directions that its loop shows. */
struct SeenGap
{
    Eigen::VectorXd gap;
    Eigen::MatrixXd of_odometry, of_loop;

    double logLikelihood(double scale) const
    {
        const Eigen::MatrixXd covariance = scale * of_odometry + of_loop;
        const Eigen::LLT<Eigen::MatrixXd> root(covariance);
        const double log_determinant = 2 * root.matrixLLT().diagonal().array().log().sum();
        return -0.5 * (log_determinant + gap.dot(root.solve(gap)));
    }
};

SeenGap seenGap(const ClosedGap& g)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(g.information);
    const double least = 1e-9 * eigen.eigenvalues().maxCoeff();
    int open = 0;
    while (open < 6 && eigen.eigenvalues()[open] <= least) open++;
    const Eigen::MatrixXd shown = eigen.eigenvectors().rightCols(6 - open);
    const Eigen::VectorXd variances = eigen.eigenvalues().tail(6 - open).cwiseInverse();
    return {
        shown.transpose() * g.gap, shown.transpose() * g.of_odometry * shown,
        Eigen::MatrixXd(variances.asDiagonal())};
}
}  // namespace

double driftScale(const std::vector<ClosedGap>& gaps)
{
    if (gaps.empty()) return 1;
    std::vector<SeenGap> seen;
    for (const ClosedGap& gap : gaps) seen.push_back(seenGap(gap));
    const double share = std::min(1.0, kMostEvidence / static_cast<double>(seen.size()));
    double best = -1e300, best_scale = 1;
    for (int i = 0; i <= kSteps; i++)
    {
        const double log_scale = std::log(kLargest) * (2.0 * i / kSteps - 1);
        double log_posterior = -0.5 * log_scale * log_scale / (kGuessDeviation * kGuessDeviation);
        for (const SeenGap& gap : seen)
            log_posterior += share * gap.logLikelihood(std::exp(log_scale));
        if (log_posterior <= best) continue;
        best = log_posterior;
        best_scale = std::exp(log_scale);
    }
    return best_scale;
}
}  // namespace taut
