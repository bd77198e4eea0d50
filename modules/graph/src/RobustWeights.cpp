#include "RobustWeights.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kLastMu = 10;  // between belief and refusal lie 10 % of the bound to each side
constexpr int kMaxDecisions = 10, kMaxHearings = 5;
constexpr double kNearBound = 4, kTorn = 4;  // times the bound
constexpr double kLeastGain = 1e-3;          // of the cost, for another verdict

double largestChi2(const RobustProblem& problem, const std::vector<std::size_t>& closures)
{
    double largest = 0;
    for (std::size_t e : closures) largest = std::max(largest, problem.chi2(e));
    return largest;
}

/** Sets the weights for that mu; tells whether all of them are 0 or 1. */
bool graduate(
    const RobustProblem& problem, const std::vector<std::size_t>& closures, double outlier_chi2,
    double mu, std::vector<double>& weights)
{
    bool decided = true;
    for (std::size_t e : closures)
    {
        weights[e] = truncatedWeight(problem.chi2(e), outlier_chi2, mu);
        decided = decided && (weights[e] == 0 || weights[e] == 1);
    }
    return decided;
}

/** Belief or refusal of each closure; tells whether any changed. */
bool decide(
    const RobustProblem& problem, const std::vector<std::size_t>& closures, double outlier_chi2,
    std::vector<double>& weights)
{
    bool changed = false;
    for (std::size_t e : closures)
    {
        const double weight = problem.chi2(e) <= outlier_chi2 ? 1 : 0;
        changed = changed || weight != weights[e];
        weights[e] = weight;
    }
    return changed;
}
/** Decides and solves until no decision changes. */
bool decideAndSolve(
    RobustProblem& problem, const std::vector<std::size_t>& closures, double outlier_chi2,
    std::vector<double>& weights)
{
    bool converged = false;
    for (int i = 0; i < kMaxDecisions; i++)
    {
        if (!decide(problem, closures, outlier_chi2, weights) && i > 0) break;
        converged = problem.minimize(weights, Effort::Full);
    }
    return converged;
}

/** Cost in which a closure counts by its residual or by the bound, whichever is less. */
double truncatedCost(
    const RobustProblem& problem, const std::vector<std::size_t>& closures, double outlier_chi2,
    const std::vector<double>& weights)
{
    double cost = problem.cost(weights);
    for (std::size_t e : closures) cost += 0.5 * outlier_chi2 * (1 - weights[e]);
    return cost;
}

/** A refused closure does not pull, so that its residual is larger than it would be if it did: near
 * the bound both verdicts stand. Takes those whose belief lowers the truncated cost. */
bool hearAgain(
    RobustProblem& problem, const std::vector<std::size_t>& closures, double outlier_chi2,
    std::vector<double>& weights)
{
    std::vector<double> others = weights;
    for (std::size_t e : closures)
        if (problem.chi2(e) <= kNearBound * outlier_chi2) others[e] = 1;
    if (others == weights) return false;
    const double cost = truncatedCost(problem, closures, outlier_chi2, weights);
    problem.save();
    problem.minimize(others, Effort::Rough);
    const bool converged = decideAndSolve(problem, closures, outlier_chi2, others);
    if (converged && truncatedCost(problem, closures, outlier_chi2, others) < cost - kLeastGain)
    {
        weights = others;
        return true;
    }
    problem.restore();
    return false;
}
}  // namespace

void RobustConfig::declare(ConfigSection& section)
{
    section.key("robust", robust, "closures may be false");
    section.key("outlier_chi2", outlier_chi2, kPositive, "beyond it a closure is false");
    section.key("growth", growth, {1.01, 100}, "of the kernel's sharpness, a solution");
}

double truncatedWeight(double chi2, double outlier_chi2, double mu)
{
    if (chi2 * (mu + 1) <= outlier_chi2 * mu) return 1;
    if (chi2 * mu >= outlier_chi2 * (mu + 1)) return 0;
    return std::clamp(std::sqrt(outlier_chi2 * mu * (mu + 1) / chi2) - mu, 0.0, 1.0);
}

bool minimizeRobustly(
    RobustProblem& problem, const std::vector<std::size_t>& closures, const RobustConfig& config,
    std::vector<double>& weights)
{
    const double bound = config.outlier_chi2;
    if (!config.robust || closures.empty()) return problem.minimize(weights, Effort::Full);

    problem.save();
    problem.minimize(weights, Effort::Rough);
    if (largestChi2(problem, closures) > kTorn * bound)
        problem.restore();
    else
    {
        const bool converged = problem.minimize(weights, Effort::Full);
        if (largestChi2(problem, closures) <= bound) return converged;
    }
    const double largest = std::max(largestChi2(problem, closures), bound);
    for (double mu = bound / (2 * largest - bound); mu < kLastMu; mu *= config.growth)
    {
        const bool decided = graduate(problem, closures, bound, mu, weights);
        problem.minimize(weights, Effort::Step);
        if (decided) break;
    }
    bool converged = decideAndSolve(problem, closures, bound, weights);
    for (int i = 0; i < kMaxHearings && hearAgain(problem, closures, bound, weights); i++)
        converged = true;
    return converged;
}
}  // namespace taut
