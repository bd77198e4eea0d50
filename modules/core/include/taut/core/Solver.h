#pragma once

#include <mrpt/rtti/CObject.h>

#include <Eigen/Core>
#include <string>

#include "taut/core/Config.h"

namespace taut
{
/** Bounded-size linear algebra: at most two states, no heap. */
using ProblemVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 30, 1>;
using ProblemMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 30, 30>;

/** A nonlinear least-squares problem on a manifold: cost(x) = 1/2 sum rho(|r|^2) with the estimate
 * kept inside. Perturbations are local, x <- x (+) delta. */
class LeastSquaresProblem
{
 public:
    virtual ~LeastSquaresProblem() = default;
    virtual int dimension() const = 0;

    /** Gauss-Newton Hessian H = J^T W J, gradient g = J^T W r, both in the local perturbation at
     * the current estimate; returns the cost there. */
    virtual double linearize(ProblemMatrix& hessian, ProblemVector& gradient) = 0;

    /** Cost at the current estimate. */
    virtual double cost() = 0;

    /** Moves the current estimate. */
    virtual void retract(const ProblemVector& delta) = 0;

    /** Remembers the current estimate, or goes back to the one remembered. */
    virtual void save() = 0;
    virtual void restore() = 0;

    /** Derivative of the local perturbation by the chart coordinate: for x = x_0 (+) z,
     * (x_0 (+) (z + dz)) = (x_0 (+) z) (+) J(z) dz. Identity but for rotations. */
    virtual ProblemMatrix chartJacobian(const ProblemVector& z) const = 0;

    /** Largest step of one iteration, by coordinate. */
    virtual ProblemVector maxStep() const = 0;
};

struct SolveReport
{
    int evaluations = 0;  //!< linearisations
    double initial_cost = 0, final_cost = 0;
    double last_step = 0;  //!< norm of the last step whitened by the Hessian: in sigmas
    bool converged = false;
    /** Why there is no optimum, as normal equations that are not positive definite: the estimate is
     * where it was or where the last good step took it. Empty if there is one. */
    std::string failure;
};

/** Plug point: minimises a problem from its current estimate, leaving the estimate at the optimum.
 */
class Solver : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Solver)
 public:
    virtual void configure(ConfigSection& section) = 0;
    virtual SolveReport solve(LeastSquaresProblem& problem) const = 0;
};
}  // namespace taut
