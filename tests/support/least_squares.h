#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "numeric.h"
#include "taut/core/Solver.h"

namespace taut::test
{
/** Gradient of the cost by the chart coordinate at z around the current estimate, as a solver in a
 * fixed chart has it: from the local gradient there. The estimate is left where it was. */
inline Eigen::VectorXd chartGradient(LeastSquaresProblem& problem, const ProblemVector& z)
{
    const int n = problem.dimension();
    ProblemMatrix H(n, n);
    ProblemVector g(n);
    problem.save();
    problem.retract(z);
    problem.linearize(H, g);
    problem.restore();
    return problem.chartJacobian(z).transpose() * g;
}

/** The same by differences of the cost. */
inline Eigen::VectorXd numericChartGradient(
    LeastSquaresProblem& problem, const ProblemVector& z, double step = 1e-6)
{
    problem.save();
    const auto cost = [&](const Eigen::VectorXd& dz) -> Eigen::VectorXd
    {
        problem.retract(z + dz);
        const double c = problem.cost();
        problem.restore();
        return Eigen::VectorXd::Constant(1, c);
    };
    return numericJacobian(cost, problem.dimension(), step).transpose();
}

/** Length of the Gauss-Newton step at the current estimate, in sigmas: 0 at an optimum. */
inline double whitenedGradient(LeastSquaresProblem& problem)
{
    const int n = problem.dimension();
    ProblemMatrix H(n, n);
    ProblemVector g(n);
    problem.linearize(H, g);
    return std::sqrt(g.dot(H.ldlt().solve(g)));
}
}  // namespace taut::test
