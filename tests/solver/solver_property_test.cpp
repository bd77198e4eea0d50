/** \file
 * What every solver must do: add a class name and its configuration below to hold another one to
 * it. */
#include <gtest/gtest.h>

#include <ostream>

#include "least_squares.h"
#include "problems.h"
#include "taut/core/Plugins.h"
#include "taut/solver/Register.h"

using namespace taut;
using namespace taut::test;

namespace
{
std::shared_ptr<Solver> makeSolver(const std::string& name, const std::string& yaml)
{
    registerSolvers();
    ConfigSection section(parseYaml(yaml), "solver");
    auto solver = createPlugin<Solver>(name);
    solver->configure(section);
    section.rejectUnknown();
    return solver;
}

struct Choice
{
    const char *label, *name, *thorough, *short_of_time;
};

void PrintTo(const Choice& choice, std::ostream* out)
{
    *out << choice.label;
}

class AnySolver : public ::testing::TestWithParam<Choice>
{
 protected:
    std::shared_ptr<Solver> solver = makeSolver(GetParam().name, GetParam().thorough);
};

/** The optimum by plain Newton steps until nothing changes. */
Pose optimumOf(SensorPoseProblem problem)
{
    makeSolver("taut::GaussNewton", "{max_iterations: 100, min_step: 1.0e-9}")->solve(problem);
    return problem.estimate;
}
}  // namespace

TEST_P(AnySolver, ReachesTheOptimumOfACurvedProblem)
{
    for (unsigned seed = 1; seed <= 5; seed++)
    {
        SensorPoseProblem problem(seed);
        Random random(seed);
        problem.estimate = {
            problem.truth.R * expSO3(random.vector(0.4)), problem.truth.p + random.vector(0.7)};
        SensorPoseProblem reference = problem;
        reference.estimate = optimumOf(problem);
        const double initial = problem.cost();

        const SolveReport report = solver->solve(problem);
        EXPECT_TRUE(report.converged);
        EXPECT_DOUBLE_EQ(report.initial_cost, initial);
        EXPECT_NEAR(report.final_cost, problem.cost(), 1e-9);  // the estimate is left there
        EXPECT_LT(report.final_cost, 100);
        EXPECT_GT(report.evaluations, 1);
        EXPECT_LT(whitenedGradient(problem), 1e-3);

        ProblemVector off(6);
        off << problem.estimate.p - reference.estimate.p,
            logSO3(reference.estimate.R.transpose() * problem.estimate.R);
        ProblemMatrix H(6, 6);
        ProblemVector g(6);
        reference.linearize(H, g);
        EXPECT_LT(std::sqrt(off.dot(H * off)), 1e-3);  // sigmas
    }
}

TEST_P(AnySolver, StaysAtTheOptimum)
{
    SensorPoseProblem problem(7);
    problem.estimate = problem.truth;
    problem.estimate = optimumOf(problem);
    const Pose before = problem.estimate;
    const SolveReport report = solver->solve(problem);
    EXPECT_TRUE(report.converged);
    EXPECT_LT((problem.estimate.p - before.p).norm(), 1e-6);
    EXPECT_LE(report.final_cost, report.initial_cost + 1e-9);
}

TEST_P(AnySolver, StoppedEarlyIsNoWorseThanTheStartAndSaysSo)
{
    SensorPoseProblem problem(8);
    problem.estimate = {expSO3({-0.5, 0.4, -0.6}), {4, -3, 3}};
    const double initial = problem.cost();
    const SolveReport report =
        makeSolver(GetParam().name, GetParam().short_of_time)->solve(problem);
    EXPECT_FALSE(report.converged);
    EXPECT_LE(problem.cost(), initial);
    EXPECT_NEAR(report.final_cost, problem.cost(), 1e-9 * initial);
}

TEST_P(AnySolver, SolvesWhereTheFullStepOvershoots)
{
    for (const double start : {2.0, -5.0})
    {
        OvershootingProblem problem;
        problem.x = start;
        solver->solve(problem);
        EXPECT_NEAR(problem.x, 0, 1e-3);
    }
}

TEST_P(AnySolver, RefusesWhatIsNotANumber)
{
    NanProblem problem(-1);
    EXPECT_FALSE(solver->solve(problem).failure.empty());
}

TEST_P(AnySolver, RefusesAProblemWithoutAUniqueSolution)
{
    SingularProblem problem;
    EXPECT_FALSE(solver->solve(problem).failure.empty());
}

TEST_P(AnySolver, RejectsUnknownKeys)
{
    EXPECT_THROW(makeSolver(GetParam().name, "no_such_key: 1"), ConfigError);
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnySolver,
    ::testing::Values(
        Choice{
            "GaussNewton", "taut::GaussNewton", "{max_iterations: 50, min_step: 1.0e-4}",
            "max_iterations: 1"},
        Choice{
            "NloptSlsqp", "taut::NloptSolver",
            "{algorithm: LD_SLSQP, max_evaluations: 300, cost_tolerance: 1.0e-10}",
            "{algorithm: LD_SLSQP, max_evaluations: 2}"},
        Choice{
            "NloptLbfgs", "taut::NloptSolver",
            "{algorithm: LD_LBFGS, max_evaluations: 300, cost_tolerance: 1.0e-10}",
            "{algorithm: LD_LBFGS, max_evaluations: 2}"}),
    ::testing::PrintToStringParamName());

TEST(GaussNewton, BoundsEveryCoordinateOfAStepAndKeepsItsDirection)
{
    const auto solver = makeSolver("taut::GaussNewton", "max_iterations: 1");
    SensorPoseProblem free(3);
    free.estimate = {free.truth.R * expSO3({0.2, 0, -0.1}), free.truth.p + Vector3d(1, -0.5, 0.2)};
    SensorPoseProblem bounded = free;
    const Pose start = free.estimate;
    bounded.max_step = 0.05;
    solver->solve(free);
    solver->solve(bounded);
    const auto stepOf = [&](const SensorPoseProblem& problem)
    {
        Eigen::Matrix<double, 6, 1> step;
        step << problem.estimate.p - start.p, logSO3(start.R.transpose() * problem.estimate.R);
        return step;
    };
    EXPECT_NEAR(stepOf(bounded).cwiseAbs().maxCoeff(), 0.05, 1e-9);
    EXPECT_GT(stepOf(free).cwiseAbs().maxCoeff(), 0.5);
    EXPECT_LT((stepOf(bounded).normalized() - stepOf(free).normalized()).norm(), 1e-9);
}

TEST(GaussNewton, DampsAStepThatRaisesTheCost)
{
    OvershootingProblem problem;
    problem.x = 2;
    const double initial = problem.cost();
    // The first steps are refused, one by one, until the damping is strong enough.
    const SolveReport one = makeSolver("taut::GaussNewton", "max_iterations: 1")->solve(problem);
    EXPECT_EQ(problem.x, 2);
    EXPECT_EQ(one.final_cost, initial);
    makeSolver("taut::GaussNewton", "max_iterations: 6")->solve(problem);
    EXPECT_LT(problem.cost(), 0.5 * initial);
}

TEST(GaussNewton, NeverAcceptsAStepToWhereTheCostIsNotANumber)
{
    // The full step from 0 leads to 2, the optimum is at log 3 = 1.1.
    const auto solver = makeSolver("taut::GaussNewton", "max_iterations: 1");
    NanProblem problem(1.5);
    const SolveReport report = solver->solve(problem);
    EXPECT_EQ(problem.x, 0);
    EXPECT_EQ(report.final_cost, report.initial_cost);
    makeSolver("taut::GaussNewton", "max_iterations: 50")->solve(problem);
    EXPECT_NEAR(problem.x, std::log(3), 0.02);
}

TEST(NloptSolver, KnowsItsAlgorithmsByName)
{
    EXPECT_THROW(makeSolver("taut::NloptSolver", "algorithm: LN_COBYLA"), ConfigError);
}

TEST(SensorPoseProblem, GradientIsThatOfTheCostInTheLocalAndInAFixedChart)
{
    SensorPoseProblem problem(4);
    problem.estimate = {expSO3({0.1, -0.4, 0.2}), {0.5, 1, 0}};
    Random random(4);
    for (const double size : {0.0, 0.3, 1.0})
    {
        ProblemVector z(6);
        z << random.vector(size), random.vector(size);
        const Eigen::VectorXd found = chartGradient(problem, z);
        EXPECT_LT((found - numericChartGradient(problem, z)).norm(), 1e-6 * (1 + found.norm()));
    }
}
