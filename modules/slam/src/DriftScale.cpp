#include "taut/slam/DriftScale.h"

#include <Eigen/Cholesky>
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
    const ShownDirections shown = shownDirections(g.information);
    return {
        shown.basis.transpose() * g.gap, shown.basis.transpose() * g.of_odometry * shown.basis,
        Eigen::MatrixXd(shown.information.cwiseInverse().asDiagonal())};
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
