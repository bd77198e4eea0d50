#include "taut/factors/LidarFactor.h"

#include <gtest/gtest.h>

#include "steady_turn.h"
#include "taut/preintegration/MidpointPreintegrator.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kEnd = 100 * kMillisecond;
constexpr int kSize = 2 * NavState::kSize;

/** Features of one sweep, each with a plane or a line near it. */
class LidarFactorTest : public ::testing::Test
{
 protected:
    LidarFactorTest()
    {
        const ImuSamples samples = body.samples(0, kEnd, 2 * kMillisecond);
        PreintegrationRequest request;
        request.end = kEnd;
        request.samples = &samples;
        request.previous = body.at(0);
        imu = MidpointPreintegrator().integrate(request);
        noise.sigma = 0.02;
        previous = disturbed(body.at(0), random, 0.01);
        current = disturbed(body.at(kEnd), random, 0.01);
    }

    void addPoints(int count)
    {
        features.stamp = 0;
        for (int i = 0; i < count; i++)
        {
            const Vector3d x = random.vector(8);
            const auto offset = static_cast<std::int32_t>((i + 1) * kEnd / count);
            features.points.push_back({x.cast<float>(), offset, FeatureKind::Any});
            Correspondence c;
            c.surface = i % 7 == 3 ? Surface::None : i % 3 == 0 ? Surface::Line : Surface::Plane;
            c.direction = random.vector(1).normalized();
            c.point = body.at(offset).T_world_imu * x + random.vector(0.05);
            c.sigma = 0.01 + 0.001 * (i % 5);
            correspondences.push_back(c);
        }
    }

    SweepPath pathOf(Undistortion mode) const
    {
        SweepPath path(mode, imu, body.at(0), body.at(kEnd));
        path.setStates(previous, current);
        return path;
    }

    LidarFactor factor(Executor& executor) const
    {
        LidarFactor f(features, noise, executor);
        f.setCorrespondences(correspondences, pathOf(Undistortion::Bridge), predicted, 1);
        return f;
    }

    SteadyTurn body;
    Random random{1};
    PreintegratedImu imu;
    NavState previous, current;
    Features features;
    std::vector<Correspondence> correspondences;
    LidarNoiseConfig noise;
    LidarFactor::PoseCovariance predicted = LidarFactor::PoseCovariance::Zero();
    Executor single{1};
};

struct Linearised
{
    ProblemMatrix H = ProblemMatrix::Zero(kSize, kSize);
    ProblemVector g = ProblemVector::Zero(kSize);
    double cost = 0;

    Linearised(const LidarFactor& factor, const SweepPath& path, double balance)
    {
        cost = factor.linearize(path, balance, H, g);
    }
};
}  // namespace

TEST_F(LidarFactorTest, GradientIsThatOfTheCost)
{
    addPoints(700);
    predicted.diagonal() << 1e-4, 2e-4, 3e-4, 1e-5, 2e-5, 3e-5;
    const LidarFactor lidar = factor(single);
    for (const Undistortion mode :
         {Undistortion::None, Undistortion::Imu, Undistortion::IteratedImu, Undistortion::Iterated,
          Undistortion::Bridge})
        for (const Kernel kernel :
             {Kernel::None, Kernel::Huber, Kernel::Cauchy, Kernel::GemanMcClure})
        {
            noise.kernel.kind = kernel;
            SweepPath path = pathOf(mode);
            const Linearised at(lidar, path, 1.5);
            EXPECT_NEAR(at.cost, lidar.cost(path, 1.5), 1e-9 * at.cost);
            const Eigen::MatrixXd numeric = numericJacobian(
                [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
                {
                    path.setStates(
                        previous.retract(d.head<NavState::kSize>()),
                        current.retract(d.tail<NavState::kSize>()));
                    return Eigen::VectorXd::Constant(1, lidar.cost(path, 1.5));
                },
                kSize, 1e-6);
            // The path's derivative is interpolated between nodes: exact to a part in a thousand.
            const Eigen::VectorXd error = at.g - numeric.transpose();
            EXPECT_LT(error.norm(), 2e-3 * at.g.norm()) << nameOf(mode);
        }
}

TEST_F(LidarFactorTest, AFeatureIsExplainedByItsNoiseAlone)
{
    addPoints(300);
    noise.kernel = {Kernel::GemanMcClure, 3};
    predicted.diagonal().setConstant(1);  // widens the kernel, but not this
    const SweepPath path = pathOf(Undistortion::Bridge);
    LidarFactor lidar(features, noise, single);
    const std::vector<Vector3d> seen = lidar.undistort(path);
    const auto explainedAt = [&](double sigmas)
    {
        for (std::size_t i = 0; i < seen.size(); i++)
        {
            Correspondence& c = correspondences[i];
            const Vector3d off =
                c.surface == Surface::Line ? c.direction.unitOrthogonal() : c.direction;
            c.point = seen[i] + sigmas * std::hypot(noise.sigma, c.sigma) * off;
        }
        lidar.setCorrespondences(correspondences, path, predicted, 1);
        return lidar.inlierWeight(path);
    };
    const auto matched = static_cast<double>(std::count_if(
        correspondences.begin(), correspondences.end(),
        [](const Correspondence& c) { return c.surface != Surface::None; }));
    EXPECT_NEAR(explainedAt(0), matched, 1e-9);
    EXPECT_NEAR(explainedAt(2), matched * noise.kernel.weight(4), 1e-6 * matched);
    EXPECT_LT(explainedAt(30), 0.01 * matched);
}

TEST_F(LidarFactorTest, AnUncertainPredictionKeepsFarMatchesInPlay)
{
    addPoints(300);
    noise.kernel = {Kernel::GemanMcClure, 3};
    const SweepPath path = pathOf(Undistortion::Bridge);
    const std::vector<Vector3d> world = factor(single).undistort(path);
    int rows = 0, false_rows = 0;
    for (std::size_t i = 0; i < world.size(); i++)
    {
        Correspondence& c = correspondences[i];
        if (c.surface == Surface::None) continue;
        const bool is_false = i % 4 == 0;  // by 15 sigmas
        c.point = world[i] +
                  (is_false ? 0.35 : 0.0) *
                      (c.surface == Surface::Plane ? c.direction : c.direction.unitOrthogonal());
        (is_false ? false_rows : rows) += c.surface == Surface::Plane ? 1 : 2;
    }
    EXPECT_NEAR(factor(single).fit(path, 1).weights, rows, 0.01 * false_rows);
    predicted.topLeftCorner<3, 3>().setIdentity();
    EXPECT_NEAR(factor(single).fit(path, 1).weights, rows + false_rows, 0.1 * false_rows);
}

TEST_F(LidarFactorTest, MostMatchesCannotBeOutliers)
{
    addPoints(300);
    noise.kernel = {Kernel::GemanMcClure, 3};
    const SweepPath path = pathOf(Undistortion::Bridge);
    const std::vector<Vector3d> world = factor(single).undistort(path);
    int rows = 0;
    for (std::size_t i = 0; i < world.size(); i++)
    {
        Correspondence& c = correspondences[i];
        c.surface = i % 7 == 3 ? Surface::None : Surface::Plane;
        c.point = world[i] + 0.5 * c.direction;  // as after a prediction that nobody doubted
        if (c.surface == Surface::Plane) rows++;
    }
    EXPECT_GT(factor(single).fit(path, 1).weights, 0.8 * rows);
}

TEST_F(LidarFactorTest, HessianIsThatOfTheCostWhereResidualsVanish)
{
    addPoints(300);
    noise.kernel.kind = Kernel::None;
    SweepPath path = pathOf(Undistortion::Bridge);
    const LidarFactor points = factor(single);
    const std::vector<Vector3d> world = points.undistort(path);
    for (std::size_t i = 0; i < world.size(); i++) correspondences[i].point = world[i];
    const LidarFactor lidar = factor(single);
    const Linearised at(lidar, path, 1);
    EXPECT_LT(at.g.norm(), 1e-5 * at.H.norm());
    EXPECT_LT((at.H - at.H.transpose()).norm(), 1e-12 * at.H.norm());
    for (int i = 0; i < 10; i++)
    {
        Eigen::VectorXd d(kSize);
        for (int k = 0; k < kSize; k++) d[k] = 1e-4 * random.normal();
        path.setStates(
            previous.retract(d.head<NavState::kSize>()),
            current.retract(d.tail<NavState::kSize>()));
        const double expected = 0.5 * d.dot(at.H * d);
        EXPECT_NEAR(lidar.cost(path, 1), expected, 0.01 * expected);
    }
}

TEST_F(LidarFactorTest, IsBitEqualWithAnyNumberOfThreads)
{
    addPoints(3000);
    const SweepPath path = pathOf(Undistortion::Bridge);
    const LidarFactor one = factor(single);
    const Linearised expected(one, path, 1);
    const std::vector<Vector3d> points = one.undistort(path);
    for (const int threads : {2, 5})
    {
        Executor executor(threads);
        const LidarFactor many = factor(executor);
        const Linearised found(many, path, 1);
        EXPECT_EQ(found.cost, expected.cost);
        EXPECT_EQ(found.H, expected.H);
        EXPECT_EQ(found.g, expected.g);
        EXPECT_EQ(many.undistort(path), points);
    }
}

TEST_F(LidarFactorTest, AddsToWhatIsThere)
{
    addPoints(50);
    const SweepPath path = pathOf(Undistortion::Iterated);
    const LidarFactor lidar = factor(single);
    const Linearised once(lidar, path, 1);
    Linearised twice = once;
    lidar.linearize(path, 1, twice.H, twice.g);
    EXPECT_LT((twice.H - 2 * once.H).norm(), 1e-9 * once.H.norm());
    EXPECT_LT((twice.g - 2 * once.g).norm(), 1e-9 * once.g.norm());
}

TEST_F(LidarFactorTest, PointToLineIsThePapersInNorm)
{
    // Two rows across the line stand for the paper's three rows n^ (y - p0) of rank two.
    addPoints(1);
    noise.kernel.kind = Kernel::None;
    Correspondence& c = correspondences[0];
    c.surface = Surface::Line;
    const SweepPath path = pathOf(Undistortion::Iterated);
    for (int i = 0; i < 20; i++)
    {
        c.direction = random.vector(1).normalized();
        const LidarFactor lidar = factor(single);
        const Vector3d d = lidar.undistort(path)[0] - c.point;
        const double variance = noise.sigma * noise.sigma + c.sigma * c.sigma;
        const double expected = 0.5 * (hat(c.direction) * d).squaredNorm() / variance;
        EXPECT_NEAR(lidar.cost(path, 1), expected, 1e-9 * expected);
        EXPECT_NEAR(Linearised(lidar, path, 1).cost, expected, 1e-9 * expected);
    }
}

TEST_F(LidarFactorTest, PointToPlaneIsTheDistanceAlongTheNormal)
{
    addPoints(1);
    noise.kernel.kind = Kernel::None;
    Correspondence& c = correspondences[0];
    c.surface = Surface::Plane;
    const SweepPath path = pathOf(Undistortion::Iterated);
    const LidarFactor lidar = factor(single);
    const double r = c.direction.dot(lidar.undistort(path)[0] - c.point);
    const double variance = 4 * (noise.sigma * noise.sigma + c.sigma * c.sigma);  // balance of 2
    EXPECT_NEAR(lidar.cost(path, 2), 0.5 * r * r / variance, 1e-9);
}

TEST_F(LidarFactorTest, UndistortsEveryPointByThePoseAtItsTime)
{
    addPoints(600);
    const SweepPath path = pathOf(Undistortion::Bridge);
    const std::vector<Vector3d> world = factor(single).undistort(path);
    ASSERT_EQ(world.size(), features.points.size());
    for (std::size_t i = 0; i < world.size(); i++)
    {
        const Feature& f = features.points[i];
        std::size_t hint = 0;
        const Pose pose = path.poseAt(features.stamp + f.offset, hint);
        EXPECT_LT((world[i] - pose * Vector3d(f.position.cast<double>())).norm(), 1e-5);
    }
}

TEST_F(LidarFactorTest, ReducedChiSquareOfRightNoiseIsOne)
{
    const SweepPath path = pathOf(Undistortion::Bridge);
    addPoints(4000);
    noise.kernel.kind = Kernel::None;
    const std::vector<Vector3d> world = factor(single).undistort(path);
    int used = 0;
    for (std::size_t i = 0; i < world.size(); i++)
    {
        Correspondence& c = correspondences[i];
        used += c.surface != Surface::None;
        c.point = world[i] + random.vector(std::hypot(noise.sigma, c.sigma));
    }
    const LidarFactor lidar = factor(single);
    EXPECT_EQ(lidar.fit(path, 1).count, used);
    EXPECT_NEAR(lidar.fit(path, 1).reducedChi2(), 1, 0.05);
    EXPECT_NEAR(lidar.fit(path, 0.5).reducedChi2(), 4, 0.2);
}

TEST_F(LidarFactorTest, WithoutCorrespondencesThereIsNoCost)
{
    addPoints(300);
    for (Correspondence& c : correspondences) c.surface = Surface::None;
    const SweepPath path = pathOf(Undistortion::Bridge);
    const LidarFactor lidar = factor(single);
    const Linearised at(lidar, path, 1);
    EXPECT_EQ(at.cost, 0);
    EXPECT_EQ(at.H.norm(), 0);
    EXPECT_EQ(lidar.fit(path, 1).count, 0);
    EXPECT_EQ(lidar.fit(path, 1).reducedChi2(), 1);

    const Features none;
    const LidarFactor empty(none, noise, single);
    EXPECT_EQ(empty.cost(path, 1), 0);
    EXPECT_TRUE(empty.undistort(path).empty());
}
