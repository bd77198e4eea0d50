#include "taut/odometry/ScanProblem.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <ostream>

#include "least_squares.h"
#include "recording.h"
#include "steady_turn.h"
#include "taut/core/Plugins.h"
#include "taut/features/VoxelThinning.h"
#include "taut/map/OctreeMap.h"
#include "taut/odometry/registerAll.h"
#include "taut/preintegration/MidpointPreintegrator.h"

namespace taut
{
void PrintTo(Undistortion mode, std::ostream* out)
{
    *out << nameOf(mode);
}

void PrintTo(PreviousState state, std::ostream* out)
{
    *out << (state == PreviousState::Fixed ? "fixed" : "released");
}
}  // namespace taut

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

constexpr int kN = NavState::kSize;

/** A map of a room, seen from its true poses, and a scan in motion that is to be matched with it
 * from a disturbed previous state. */
struct Scene3d
{
    Recording recording;
    Executor executor{1};
    NavPrior prior;
    PreintegratedImu imu;
    Features features;
    std::vector<Correspondence> correspondences;

    Scene3d()
    {
        const Time begin = recording.start + fromSeconds(2.6);
        OctreeMap map;
        for (int i = 1; i <= 3; i++) map.insert(seen(begin - i * recording.scan_period), single);

        Random random(5);
        prior.state = recording.truth(begin);
        prior.state.bias_gyro.setZero();
        NavState::Vector sigma;
        sigma << Vector3d::Constant(0.01), Vector3d::Constant(0.03), Vector3d::Constant(0.003),
            Vector3d::Constant(0.05), Vector3d::Constant(0.005);
        NavState::Vector off;
        for (int i = 0; i < kN; i++) off[i] = i < kN - 6 ? sigma[i] * random.normal() : 0.0;
        prior.state = prior.state.retract(off);
        prior.state.t = begin;
        prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();

        const Scan scan = transformScan(recording.scan(begin), {}, begin);
        const ImuSamples samples = recording.imu();
        PreintegrationRequest request;
        request.begin = begin;
        request.end = scan.end;
        request.samples = &samples;
        request.previous = prior.state;
        imu = MidpointPreintegrator().integrate(request);

        features = VoxelThinning().extract(scan, {});
        std::vector<MapPoint> queries;
        for (const Feature& f : features.points)
            queries.push_back({truePoint(scan.stamp + f.offset, f.position), f.kind});
        MapScratch scratch;
        map.match(queries, correspondences, scratch, executor);
    }

    Vector3d truePoint(Time t, const Eigen::Vector3f& p) const
    {
        return recording.pose(toSeconds(t - recording.start)) * Vector3d(p.cast<double>());
    }

    std::vector<MapPoint> seen(Time t) const
    {
        const Scan scan = transformScan(recording.scan(t), {}, t - 1);
        std::vector<MapPoint> points;
        for (const LidarPoint& p : scan.points)
            points.push_back({truePoint(scan.timeOf(p), p.position), FeatureKind::Any});
        return points;
    }
};

const Scene3d& scene()
{
    static const Scene3d made;
    return made;
}

/** The problem of that scan, for one choice of modes. */
struct Instance
{
    Instance(Undistortion mode, PreviousState previous)
    {
        config.undistortion = mode;
        config.previous_state = previous;
        path.emplace(mode, scene().imu, scene().prior.state, predicted());
        problem.emplace(scene().prior, scene().imu, lidar, *path, config);
        lidar.setCorrespondences(
            scene().correspondences, *path, problem->predictedPoseCovariance(), 1);
    }

    static NavState predicted() { return predict(scene().imu, scene().prior.state); }

    EstimationConfig config;
    LidarNoiseConfig noise;
    Executor executor{1};
    LidarFactor lidar{scene().features, noise, executor};
    std::optional<SweepPath> path;
    std::optional<ScanProblem> problem;
};

ProblemVector randomStep(Random& random, int n, double size)
{
    ProblemVector d(n);
    for (int i = 0; i < n; i++)
        d[i] = size * random.normal() * (i % kN < NavState::kBiasAccel ? 1 : 0.1);
    return d;
}

/** Largest deviation of A^-1 B from the identity, both symmetric and positive. */
double disagreement(const NavState::Matrix& A, const NavState::Matrix& B)
{
    const NavState::Matrix L = A.llt().matrixL();
    const NavState::Matrix half = L.triangularView<Eigen::Lower>().solve(B);
    const NavState::Matrix whitened =
        L.triangularView<Eigen::Lower>().solve(NavState::Matrix(half.transpose()));
    return (whitened - NavState::Matrix::Identity()).cwiseAbs().maxCoeff();
}

using Modes = std::tuple<Undistortion, PreviousState>;

class AnyScanProblem : public ::testing::TestWithParam<Modes>
{
 protected:
    Instance instance{std::get<0>(GetParam()), std::get<1>(GetParam())};
    ScanProblem& problem = *instance.problem;
};
}  // namespace

TEST_P(AnyScanProblem, GradientIsThatOfTheCostInAnyChart)
{
    Random random(1);
    for (const double size : {0.0, 0.03, 0.2})
    {
        if (size == 0.03)
            problem.setMotionPrior(
                {{expSO3({0.1, -0.3, 0.2}), {1, 2, 3}}, 0.02, 0.05, 0.3, {1, -2, 0.5}});
        problem.retract(randomStep(random, problem.dimension(), 0.02));
        const ProblemVector z = randomStep(random, problem.dimension(), size);
        const Eigen::VectorXd found = chartGradient(problem, z);
        const Eigen::VectorXd numeric = numericChartGradient(problem, z);
        // The path's derivative is interpolated between nodes: exact to a part in a thousand.
        EXPECT_LT((found - numeric).norm(), 2e-3 * numeric.norm());
    }
}

TEST_P(AnyScanProblem, LinearizeGivesTheCostAndASymmetricHessian)
{
    Random random(2);
    const int n = problem.dimension();
    problem.retract(randomStep(random, n, 0.02));
    ProblemMatrix H = ProblemMatrix::Constant(n, n, 7);  // must be overwritten
    ProblemVector g = ProblemVector::Constant(n, 7);
    const double cost = problem.linearize(H, g);
    EXPECT_NEAR(cost, problem.cost(), 1e-9 * cost);
    EXPECT_LT((H - H.transpose()).norm(), 1e-9 * H.norm());
    EXPECT_EQ(H.llt().info(), Eigen::Success);
    ProblemMatrix again(n, n);
    ProblemVector g_again(n);
    problem.linearize(again, g_again);
    EXPECT_EQ(H, again);
}

TEST_P(AnyScanProblem, MarginalInformationIsTheInverseOfTheMarginalCovariance)
{
    const int n = problem.dimension();
    ProblemMatrix H(n, n);
    ProblemVector g(n);
    problem.linearize(H, g);
    // Scaled before it is inverted: the entries span many orders of magnitude.
    const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd covariance =
        scale.asDiagonal() *
        Eigen::MatrixXd(scale.asDiagonal() * H * scale.asDiagonal()).inverse() * scale.asDiagonal();
    const NavState::Matrix expected =
        NavState::Matrix(covariance.bottomRightCorner<kN, kN>()).inverse();
    EXPECT_LT(disagreement(expected, problem.marginalInformation()), 1e-5);
}

TEST_P(AnyScanProblem, ChartJacobianIsThatOfTheRetraction)
{
    Random random(3);
    const int n = problem.dimension();
    const ProblemVector z = randomStep(random, n, 0.5);
    const auto moved = [&](const ProblemVector& d)
    {
        problem.save();
        problem.retract(d);
        const std::pair<NavState, NavState> states{problem.previous(), problem.current()};
        problem.restore();
        return states;
    };
    const auto at = moved(z);
    const Eigen::MatrixXd numeric = numericJacobian(
        [&](const Eigen::VectorXd& dz) -> Eigen::VectorXd
        {
            const auto [previous, current] = moved(z + dz);
            Eigen::VectorXd local(2 * kN);
            local << previous.localFrom(at.first), current.localFrom(at.second);
            return local.tail(n);
        },
        n);
    EXPECT_LT((problem.chartJacobian(z) - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

TEST_P(AnyScanProblem, WithoutLidarTheOptimumIsThePrediction)
{
    problem.useLidar(false);
    EXPECT_LT(problem.current().localFrom(Instance::predicted()).norm(), 1e-12);
    EXPECT_LT(problem.cost(), 1e-12);
    EXPECT_LT(whitenedGradient(problem), 1e-6);
    EXPECT_EQ(problem.lidarInformation().norm(), 0);
}

TEST_P(AnyScanProblem, PredictedPoseCovarianceIsThatOfTheProblemWithoutLidar)
{
    instance.config.bias_time = 1e12;  // the absolute prior of the biases is not in the prediction
    problem.useLidar(false);
    problem.relinearize();
    const NavState::Matrix covariance = problem.marginalInformation().inverse();
    const LidarFactor::PoseCovariance found = problem.predictedPoseCovariance();
    for (const auto& [at, row] : {std::pair(NavState::kPosition, 0), {NavState::kRotation, 3}})
    {
        const Matrix3d expected = covariance.block<3, 3>(at, at);
        EXPECT_LT((found.block<3, 3>(row, row) - expected).norm(), 1e-3 * expected.norm());
    }
}

TEST_P(AnyScanProblem, AllSolversReachTheSameOptimum)
{
    registerAll();
    const auto optimumBy = [&](const std::string& name, const std::string& yaml)
    {
        ConfigSection section(parseYaml(yaml));
        const auto solver = createPlugin<Solver>(name);
        solver->configure(section);
        Instance own{std::get<0>(GetParam()), std::get<1>(GetParam())};
        EXPECT_TRUE(solver->solve(*own.problem).converged) << name;
        NavState::Vector both[2] = {
            own.problem->previous().localFrom(problem.previous()),
            own.problem->current().localFrom(problem.current())};
        Eigen::VectorXd at(2 * kN);
        at << both[0], both[1];
        return Eigen::VectorXd(at.tail(problem.dimension()));
    };
    const int n = problem.dimension();
    ProblemMatrix H(n, n);
    ProblemVector g(n);
    problem.linearize(H, g);
    const auto sigmas = [&](const Eigen::VectorXd& d) { return std::sqrt(d.dot(H * d)); };
    const Eigen::VectorXd newton =
        optimumBy("taut::GaussNewton", "{max_iterations: 100, min_step: 1.0e-6}");
    EXPECT_GT(sigmas(newton), 1);  // it has some way to go
    for (const std::string algorithm : {"LD_SLSQP", "LD_LBFGS"})
    {
        const Eigen::VectorXd found = optimumBy(
            "taut::NloptSolver",
            "{algorithm: " + algorithm + ", max_evaluations: 1000, cost_tolerance: 1.0e-12}");
        EXPECT_LT(sigmas(found - newton), 1e-3) << algorithm;
    }
}

TEST_P(AnyScanProblem, BringsTheStateCloserToTheTruth)
{
    registerAll();
    ConfigSection section;
    const auto solver = createPlugin<Solver>("taut::GaussNewton");
    solver->configure(section);
    solver->solve(problem);
    const NavState truth = scene().recording.truth(scene().imu.end());
    const double before = (Instance::predicted().T_world_imu.p - truth.T_world_imu.p).norm();
    const double after = (problem.current().T_world_imu.p - truth.T_world_imu.p).norm();
    // Where the previous state is held, its error stays in part.
    const bool released = std::get<1>(GetParam()) == PreviousState::Released;
    EXPECT_LT(after, (released ? 0.5 : 0.95) * before);
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyScanProblem,
    ::testing::Combine(
        ::testing::Values(
            Undistortion::Imu, Undistortion::IteratedImu, Undistortion::Iterated,
            Undistortion::Bridge),
        ::testing::Values(PreviousState::Fixed, PreviousState::Released)),
    [](const auto& test)
    {
        std::string name = nameOf(std::get<0>(test.param));
        std::replace(name.begin(), name.end(), '-', '_');
        return name + (std::get<1>(test.param) == PreviousState::Fixed ? "_fixed" : "_released");
    });

TEST(ScanProblem, APreviousStateHeldIsAsUncertainAsOneReleased)
{
    // Without LiDAR both are the same prediction: its covariance may not depend on how the previous
    // state is treated.
    Instance fixed(Undistortion::Bridge, PreviousState::Fixed);
    Instance released(Undistortion::Bridge, PreviousState::Released);
    fixed.problem->useLidar(false);
    released.problem->useLidar(false);
    fixed.problem->relinearize();
    released.problem->relinearize();
    EXPECT_LT(
        disagreement(fixed.problem->marginalInformation(), released.problem->marginalInformation()),
        1e-5);
}

TEST(ScanProblem, ABodyAtRestIsKnownToBeWhereItWas)
{
    Instance instance(Undistortion::Bridge, PreviousState::Released);
    ScanProblem& problem = *instance.problem;
    problem.useLidar(false);
    constexpr double sway = 0.003, turn = 0.002, speed = 0.01;
    problem.relinearize();
    const NavState::Matrix moving = problem.marginalInformation();
    problem.setMotionPrior({problem.current().T_world_imu, sway, turn, speed, {1, 0, 0}});
    problem.relinearize();
    const NavState::Matrix gained = problem.marginalInformation() - moving;
    NavState::Matrix expected = NavState::Matrix::Zero();
    expected.diagonal().segment<3>(NavState::kPosition).setConstant(1 / square(sway));
    expected.diagonal().segment<3>(NavState::kVelocity).setConstant(1 / square(speed));
    expected.diagonal().segment<3>(NavState::kRotation).setConstant(1 / square(turn));
    EXPECT_LT((gained - expected).norm(), 1e-6 * expected.norm());
}

TEST(ScanProblem, BalanceScalesTheLidarBlock)
{
    Instance instance(Undistortion::Bridge, PreviousState::Released);
    instance.noise.kernel.kind = Kernel::None;
    instance.problem->relinearize();
    const NavState::Matrix once = instance.problem->lidarInformation();
    instance.problem->setBalance(2);
    instance.problem->relinearize();
    const NavState::Matrix halved = instance.problem->lidarInformation();
    EXPECT_LT((once - 4 * halved).norm(), 1e-9 * once.norm());
}

TEST(ScanProblem, StepsAreBoundedInEveryCoordinate)
{
    Instance instance(Undistortion::Bridge, PreviousState::Released);
    const ProblemVector most = instance.problem->maxStep();
    ASSERT_EQ(most.size(), 2 * kN);
    for (int i = 0; i < 3; i++)
        for (const int state : {0, kN})
        {
            const EstimationConfig& c = instance.config;
            EXPECT_EQ(most[state + NavState::kPosition + i], c.max_step_position);
            EXPECT_EQ(most[state + NavState::kVelocity + i], c.max_step_velocity);
            EXPECT_EQ(most[state + NavState::kRotation + i], c.max_step_rotation);
            EXPECT_EQ(most[state + NavState::kBiasAccel + i], c.max_step_bias_accel);
            EXPECT_EQ(most[state + NavState::kBiasGyro + i], c.max_step_bias_gyro);
        }
}

TEST(ScanProblem, ManyNormalsThatErrSayNothingOfAnOpenDirection)
{
    // A plain corridor along x: of its surfaces none looks that way, but for a degree of error.
    const auto informationAlong = [](double tilt, double open_share, double shown_share)
    {
        Instance instance(Undistortion::Bridge, PreviousState::Released);
        instance.config.open_share = open_share;
        instance.config.shown_share = shown_share;
        std::vector<Correspondence> corridor = scene().correspondences;
        Random random(8);
        for (std::size_t i = 0; i < corridor.size(); i++)
        {
            if (corridor[i].surface != Surface::Plane) continue;
            const Vector3d normal = i % 2 == 0 ? Vector3d::UnitY() : Vector3d::UnitZ();
            corridor[i].direction =
                (normal + tilt * random.normal() * Vector3d::UnitX()).normalized();
            corridor[i].point = scene().truePoint(
                scene().features.stamp + scene().features.points[i].offset,
                scene().features.points[i].position);
        }
        instance.lidar.setCorrespondences(
            corridor, *instance.path, instance.problem->predictedPoseCovariance(), 1);
        instance.problem->relinearize();
        return instance.problem->lidarInformation().block<3, 3>(0, 0).eval();
    };
    const Matrix3d believed = informationAlong(0.01, 0, 1e-9);
    const Matrix3d left_open = informationAlong(0.01, 3e-4, 1e-3);
    EXPECT_GT(believed(0, 0), 100);  // hundreds of matches that know a decimetre each
    EXPECT_LT(left_open(0, 0), 0.01 * believed(0, 0));
    EXPECT_NEAR(left_open(1, 1) / believed(1, 1), 1, 1e-3);
    EXPECT_NEAR(left_open(2, 2) / believed(2, 2), 1, 1e-3);
    // What is shown is left as it is.
    const Matrix3d shown = informationAlong(0.1, 0, 1e-9);
    EXPECT_LT((informationAlong(0.1, 3e-4, 1e-3) - shown).norm(), 1e-9 * shown.norm());
}
