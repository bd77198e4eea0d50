#pragma once

#include "taut/core/GraphOptimizer.h"
#include "taut/graph/RobustConfig.h"

namespace taut
{
struct DenseGraphConfig
{
    int max_iterations = 100;  //!< of one solution
    double min_step = 1e-7;    //!< whitened step, in sigmas, below which it has converged
    RobustConfig closures;
};

/** Gauss-Newton with dense matrices, quaternions and numeric Jacobians: a reference that shares
 * nothing with the other but the schedule of the robust weights and what is held. Time grows with
 * the cube of the vertices: for some hundred at most. */
class DenseGraphOptimizer : public GraphOptimizer
{
    DEFINE_MRPT_OBJECT(DenseGraphOptimizer, taut)
 public:
    void configure(ConfigSection& section) override;
    GraphReport optimize(PoseGraph& graph) const override;
    std::shared_ptr<const GraphCovariance> covariance(
        const PoseGraph& graph, const std::vector<double>& weights) const override;

    DenseGraphConfig config;
};
}  // namespace taut
