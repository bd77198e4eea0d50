// Both solvers on the problems of recordings: the same optimum, whichever of them is chosen.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data_folder.h"
#include "taut/core/Plugins.h"
#include "taut/odometry/Pipeline.h"
#include "taut/odometry/registerAll.h"
#include "taut/rawlog/RawlogSource.h"

namespace
{
using namespace taut;

constexpr int kN = NavState::kSize;
constexpr int kEveryNth = 40;  // problem, for time

std::shared_ptr<Solver> solverOf(const std::string& name, const std::string& settings)
{
    ConfigSection section(parseYaml(settings), "solver");
    const auto solver = createPlugin<Solver>(name);
    solver->configure(section);
    return solver;
}

/** Solves as Gauss-Newton does; every now and then to the end, and with NLopt from the same start.
 */
class BothSolvers : public Solver
{
 public:
    void configure(ConfigSection&) override {}
    mrpt::rtti::CObject* clone() const override { return new BothSolvers(*this); }

    SolveReport solve(LeastSquaresProblem& any) const override
    {
        auto& problem = dynamic_cast<ScanProblem&>(any);
        if (problems_++ % kEveryNth != 0) return usual_->solve(problem);
        const States start{problem.previous(), problem.current()};
        nlopt_->solve(problem);
        const States by_nlopt{problem.previous(), problem.current()};
        problem.retract(start.from({problem.previous(), problem.current()}));
        const SolveReport report = exact_->solve(problem);
        const ProblemVector d = by_nlopt.from({problem.previous(), problem.current()});
        ProblemMatrix H;
        ProblemVector g;
        problem.linearize(H, g);
        found->compared++;
        found->furthest = std::max(found->furthest, std::sqrt(d.dot(H * d)));
        return report;
    }

    /** What was found, by this one and all its copies. */
    struct Found
    {
        int compared = 0;
        double furthest = 0;  //!< of both optima from each other [sigmas]
    };
    std::shared_ptr<Found> found = std::make_shared<Found>();

 private:
    struct States
    {
        NavState previous, current;
        ProblemVector from(const States& origin) const
        {
            ProblemVector d(2 * kN);
            d << previous.localFrom(origin.previous), current.localFrom(origin.current);
            return d;
        }
    };

    std::shared_ptr<Solver> usual_ = solverOf("taut::GaussNewton", "{}");
    std::shared_ptr<Solver> exact_ =
        solverOf("taut::GaussNewton", "{max_iterations: 200, min_step: 1.0e-6}");
    std::shared_ptr<Solver> nlopt_ =
        solverOf("taut::NloptSolver", "{max_evaluations: 2000, cost_tolerance: 1.0e-12}");
    mutable int problems_ = 0;
};

class RecordedProblems : public ::testing::TestWithParam<const char*>
{
};

TEST_P(RecordedProblems, HaveTheSameOptimumForBothSolvers)
{
    RawlogConfig log;
    log.path = std::string(TAUT_RAWLOGS) + "/" + GetParam() + ".rawlog";
    if (!std::filesystem::exists(log.path))
        log.path = (test::dataFolder() / (std::string(GetParam()) + ".rawlog")).string();
    if (!std::filesystem::exists(log.path))
        return test::skipWithout(GetParam() + std::string(".rawlog"));
    log.only_first_n = 200;

    registerAll();
    ConfigSection root(readYamlFile(TAUT_CONFIG "/default.yaml"));
    OdometryConfig config = OdometryConfig::read(root);
    const auto solver = std::make_shared<BothSolvers>();
    config.solver = Prototype<Solver>(solver);
    Executor executor(1);
    Pipeline pipeline(config, executor, nullptr, [](const Event&) {});
    RawlogSource source(log);
    while (auto m = source.next())
    {
        if (const auto* sample = std::get_if<ImuSample>(&*m))
            pipeline.add(*sample);
        else
            pipeline.add(std::move(std::get<Scan>(*m)));
    }
    pipeline.finish();
    EXPECT_GT(solver->found->compared, 4);
    EXPECT_LT(solver->found->furthest, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Of, RecordedProblems,
    ::testing::Values("hall_fast", "hall_violent", "handheld_real_imu", "tripod_vlp16_imu"),
    [](const auto& test) { return std::string(test.param); });
}  // namespace
