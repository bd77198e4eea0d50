#pragma once

#include "taut/core/GraphOptimizer.h"
#include "taut/graph/RobustConfig.h"

namespace taut
{
struct SparseGraphConfig
{
    int max_iterations = 100;  //!< of one solution
    double min_step = 1e-6;    //!< whitened step, in sigmas, below which it has converged
    RobustConfig closures;
};

/** Levenberg-Marquardt on a sparse Cholesky factorisation, in one thread: for graphs of any size.
 * The result does not depend on the order of vertices and edges, to the bit. */
class SparseGraphOptimizer : public GraphOptimizer
{
    DEFINE_MRPT_OBJECT(SparseGraphOptimizer, taut)
 public:
    void configure(ConfigSection& section) override;
    GraphReport optimize(PoseGraph& graph) const override;
    std::shared_ptr<const GraphCovariance> covariance(
        const PoseGraph& graph, const std::vector<double>& weights) const override;

    SparseGraphConfig config;
};
}  // namespace taut
