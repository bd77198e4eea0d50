#pragma once

#include <string>

#include "taut/core/Solver.h"

namespace taut
{
struct NloptConfig
{
    std::string algorithm = "LD_SLSQP";  //!< or LD_LBFGS
    int max_evaluations = 100;
    double cost_tolerance = 1e-9;  //!< absolute; a cost is half a squared number of sigmas
};

/** NLopt on the same problem, in the fixed chart around the first estimate, whitened by the
 * Cholesky factor of the first Gauss-Newton Hessian: x = x_0 (+) U^-1 z. */
class NloptSolver : public Solver
{
    DEFINE_MRPT_OBJECT(NloptSolver, taut)
 public:
    void configure(ConfigSection& section) override;
    SolveReport solve(LeastSquaresProblem& problem) const override;

    NloptConfig config;
};
}  // namespace taut
