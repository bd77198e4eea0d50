#include "taut/solver/NloptSolver.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <nlopt.hpp>
#include <stdexcept>
#include <vector>

IMPLEMENTS_MRPT_OBJECT(NloptSolver, taut::Solver, taut)

namespace taut
{
namespace
{
/** The problem as NLopt sees it: cost and gradient of the whitened coordinate z. */
struct WhitenedProblem
{
    LeastSquaresProblem& problem;
    Eigen::LLT<ProblemMatrix> llt;  // of the first Hessian, L L^T; x = x_0 (+) L^-T z
    int evaluations = 0;

    ProblemVector step(const std::vector<double>& z) const
    {
        const ProblemVector v = Eigen::Map<const Eigen::VectorXd>(z.data(), problem.dimension());
        return llt.matrixU().solve(v);
    }

    static double evaluate(const std::vector<double>& z, std::vector<double>& gradient, void* data)
    {
        auto& self = *static_cast<WhitenedProblem*>(data);
        const ProblemVector delta = self.step(z);
        const int n = self.problem.dimension();
        ProblemMatrix H(n, n);
        ProblemVector g(n);
        self.evaluations++;
        self.problem.restore();  // to x_0
        self.problem.retract(delta);
        const double cost = self.problem.linearize(H, g);
        if (!gradient.empty())
        {
            // From the local perturbation at x_0 (+) delta back to the fixed chart at x_0.
            const ProblemVector in_chart = self.problem.chartJacobian(delta).transpose() * g;
            const ProblemVector whitened = self.llt.matrixL().solve(in_chart);
            Eigen::Map<Eigen::VectorXd>(gradient.data(), n) = whitened;
        }
        return cost;
    }
};

nlopt::algorithm algorithmOf(const std::string& name)
{
    return name == "LD_LBFGS" ? nlopt::LD_LBFGS : nlopt::LD_SLSQP;
}
}  // namespace

void NloptSolver::configure(ConfigSection& section)
{
    section.choice<std::string>(
        "algorithm", config.algorithm, {{"LD_SLSQP", "LD_SLSQP"}, {"LD_LBFGS", "LD_LBFGS"}},
        "NLopt's name");
    section.key("max_evaluations", config.max_evaluations, {1, 1e6}, "count");
    section.key("cost_tolerance", config.cost_tolerance, kPositive, "absolute, of the cost");
}

SolveReport NloptSolver::solve(LeastSquaresProblem& problem) const
{
    const int n = problem.dimension();
    ProblemMatrix H(n, n);
    ProblemVector g(n);
    SolveReport report;
    report.initial_cost = problem.linearize(H, g);
    problem.save();

    WhitenedProblem whitened{problem, Eigen::LLT<ProblemMatrix>(H)};
    // Eigen's factorisation lets NaN pass, and NLopt would search on among them.
    if (whitened.llt.info() != Eigen::Success || !H.allFinite() || !g.allFinite())
    {
        report.failure = "the normal equations are not positive definite or not finite";
        return report;
    }

    nlopt::opt opt(algorithmOf(config.algorithm), static_cast<unsigned>(n));
    opt.set_min_objective(&WhitenedProblem::evaluate, &whitened);
    opt.set_ftol_abs(config.cost_tolerance);
    opt.set_maxeval(config.max_evaluations);
    std::vector<double> z(static_cast<std::size_t>(n), 0.0);
    double cost = report.initial_cost;
    try
    {
        const nlopt::result result = opt.optimize(z, cost);
        report.converged = result != nlopt::MAXEVAL_REACHED;
    }
    catch (const nlopt::roundoff_limited&)
    {
        report.converged = true;  // z is the best found: as exact as doubles allow
    }
    catch (const std::runtime_error& e)
    {
        // NLopt's own word for a line search that gets no further, with the best found in z. The
        // whitened gradient there, in sigmas, tells whether that is the optimum.
        if (std::string(e.what()) != "nlopt failure") throw;
        std::vector<double> gradient(z.size());
        WhitenedProblem::evaluate(z, gradient, &whitened);
        report.converged = Eigen::Map<const Eigen::VectorXd>(gradient.data(), n).norm() < 1e-3;
    }
    problem.restore();
    if (!std::isfinite(cost))
    {
        report.failure = "the cost at NLopt's result is not finite";
        return report;
    }
    const ProblemVector delta = whitened.step(z);
    problem.retract(delta);
    report.evaluations = whitened.evaluations + 1;
    report.final_cost = cost;
    report.last_step = Eigen::Map<const Eigen::VectorXd>(z.data(), n).norm();
    return report;
}
}  // namespace taut
