#pragma once

#include "taut/core/Solver.h"

namespace taut
{
struct GaussNewtonConfig
{
    int max_iterations = 3;
    double min_step = 0.1;        //!< whitened step, in sigmas, below which it has converged
    double first_damping = 1e-2;  //!< of the Hessian's diagonal, after a step that did not help
};

/** Gauss-Newton with steps bounded by coordinate, and with damping (Marquardt's: of the diagonal)
 * as soon as a step raises the cost. */
class GaussNewton : public Solver
{
    DEFINE_MRPT_OBJECT(GaussNewton, taut)
 public:
    void configure(ConfigSection& section) override;
    SolveReport solve(LeastSquaresProblem& problem) const override;

    GaussNewtonConfig config;
};
}  // namespace taut
