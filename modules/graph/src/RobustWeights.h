#pragma once

#include <cstddef>
#include <vector>

#include "taut/graph/RobustConfig.h"

namespace taut
{
enum class Effort
{
    Step,   // one step that lowers the cost
    Rough,  // to a tenth of a sigma, if a few steps get there
    Full    // to the optimum
};

/** What the schedule of the robust weights asks of an optimiser. */
class RobustProblem
{
 public:
    virtual ~RobustProblem() = default;

    /** Moves the estimate to the optimum of these weights; tells whether it got there. */
    virtual bool minimize(const std::vector<double>& weights, Effort effort) = 0;

    /** r^T Omega r of an edge at the estimate. */
    virtual double chi2(std::size_t edge) const = 0;

    /** 1/2 sum w r^T Omega r of all edges at the estimate. */
    virtual double cost(const std::vector<double>& weights) const = 0;

    /** Remembers the estimate, or goes back to the one remembered. */
    virtual void save() = 0;
    virtual void restore() = 0;
};

/** First all closures are believed. If that leaves none beyond the bound, this is the result. If it
 * leaves some that are far beyond it, the graph is torn, and starts again at the first estimate.
 * The weights are then graduated from its residuals on; each closure is believed or refused; and
 * the graph is solved once more with what is believed.
 *
 * `closures` are the edges that may be false. `weights` begins with 1 for every edge that pulls and
 * has 1 or 0 at the end. Returns whether the last solution converged. */
bool minimizeRobustly(
    RobustProblem& problem, const std::vector<std::size_t>& closures, const RobustConfig& config,
    std::vector<double>& weights);
}  // namespace taut
