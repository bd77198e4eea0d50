#include "taut/solver/GaussNewton.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

IMPLEMENTS_MRPT_OBJECT(GaussNewton, taut::Solver, taut)

namespace taut
{
namespace
{
/** Shortens the step as a whole until no coordinate exceeds its bound. */
void bound(ProblemVector& step, const ProblemVector& max_step)
{
    const double excess = (step.array().abs() / max_step.array()).maxCoeff();
    if (excess > 1) step /= excess;
}
}  // namespace

void GaussNewton::configure(ConfigSection& section)
{
    section.key("max_iterations", config.max_iterations, {1, 1000}, "for one set of matches");
    section.key("min_step", config.min_step, kPositive, "sigmas, whitened step that is converged");
    section.key("first_damping", config.first_damping, kPositive, "share of the diagonal");
}

SolveReport GaussNewton::solve(LeastSquaresProblem& problem) const
{
    const int n = problem.dimension();
    ProblemMatrix H(n, n), H_next(n, n);
    ProblemVector g(n), g_next(n);
    SolveReport report;
    double cost = problem.linearize(H, g);
    report.evaluations = 1;
    report.initial_cost = report.final_cost = cost;

    double damping = 0;
    for (int i = 0; i < config.max_iterations; i++)
    {
        ProblemMatrix A = H;
        A.diagonal() *= 1 + damping;
        const Eigen::LLT<ProblemMatrix> llt(A);
        ProblemVector step = llt.solve(-g);
        if (llt.info() != Eigen::Success || !step.allFinite())
        {
            report.failure = "the normal equations are not positive definite or not finite";
            return report;
        }
        bound(step, problem.maxStep());
        report.last_step = std::sqrt(std::max(0.0, step.dot(H * step)));

        problem.save();
        problem.retract(step);
        const double next = problem.linearize(H_next, g_next);
        report.evaluations++;
        if (!(next <= cost + 1e-9 * std::abs(cost)))  // raised, or not a number
        {
            problem.restore();
            damping = damping == 0 ? config.first_damping : damping * 10;
            if (report.last_step < config.min_step)
            {
                report.converged = true;
                break;
            }
            continue;
        }
        H = H_next;
        g = g_next;
        cost = report.final_cost = next;
        damping = damping < config.first_damping ? 0 : damping / 10;
        if (report.last_step < config.min_step)
        {
            report.converged = true;
            break;
        }
    }
    return report;
}
}  // namespace taut
