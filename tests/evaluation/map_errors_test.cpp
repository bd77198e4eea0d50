#include <gtest/gtest.h>

#include "surfaces.h"
#include "taut/evaluation/MapScores.h"

using namespace taut;
using test::Points;

namespace
{
TrueSurface flat(double side)
{
    TriangleMesh mesh;
    test::addRectangle(mesh, {-side, -side, 0}, {3 * side, 0, 0}, {0, 3 * side, 0});
    return TrueSurface(mesh);
}

TrueSurface cloudOf(const Points& points)
{
    TriangleMesh cloud;
    for (const auto& p : points) cloud.vertices.push_back(p.cast<double>());
    return TrueSurface(cloud);
}

MapErrors score(const Points& map, const TrueSurface& truth, const MapErrorOptions& options = {})
{
    Executor executor(1);
    return scoreMap(map, truth, options, executor);
}

const Vector3d kRoom(6, 5, 3);
const Pose kOff{expSO3({0.01, -0.02, 0.03}), {0.12, -0.2, 0.05}};
}  // namespace

TEST(MapErrors, OfANoisyPlaneAreThoseOfAHalfNormalDistribution)
{
    const double sigma = 0.02;
    const MapErrors e = score(test::noisyPlane(10, 100'000, sigma), flat(10));
    EXPECT_EQ(e.distance.count, 100'000U);
    EXPECT_NEAR(e.distance.rmse, sigma, 0.01 * sigma);
    EXPECT_NEAR(e.distance.mean, sigma * std::sqrt(2 / M_PI), 0.01 * sigma);
    EXPECT_NEAR(e.distance.median, 0.67449 * sigma, 0.01 * sigma);
    EXPECT_NEAR(e.percentile95, 1.95996 * sigma, 0.02 * sigma);
    EXPECT_NEAR(e.near_share, 0.98758, 0.002) << "5 cm are two and a half deviations";
}

TEST(MapErrors, HalfABoxIsHalfComplete)
{
    Points half;
    const std::vector<test::Face> faces = test::facesOfBox({2, 2, 2});
    for (std::size_t i = 0; i < 3; i++)
        test::addLattice(half, faces[i].corner, faces[i].a, faces[i].b, 0.02);
    const TrueSurface box(test::boxMesh({2, 2, 2}));
    // The other three have a strip of 5 cm along two of their sides.
    const double strips = 1 - square(1.95 / 2);
    EXPECT_NEAR(score(half, box).completeness, (3 + 3 * strips) / 6, 0.002);
    MapErrorOptions wide;
    wide.within = 0.2;
    EXPECT_NEAR(score(half, box, wide).completeness, (3 + 3 * (1 - square(1.8 / 2))) / 6, 0.001);
    EXPECT_EQ(score(test::boxPoints({2, 2, 2}, 0.02), box).completeness, 1);
    EXPECT_NEAR(score(half, box).distance.max, 0, 1e-6);
}

TEST(MapErrors, AShiftedMapIsOffByTheShift)
{
    const MapErrors e = score(
        test::moved({Matrix3d::Identity(), {3, 1, 0.07}}, test::noisyPlane(5, 1000, 0)), flat(10));
    EXPECT_NEAR(e.distance.mean, 0.07, 1e-6);
    EXPECT_NEAR(e.distance.median, 0.07, 1e-6);
    EXPECT_EQ(e.near_share, 0);
    EXPECT_EQ(e.completeness, 0);
    MapErrorOptions back;
    back.T_truth_map.p.z() = -0.07;
    EXPECT_NEAR(
        score(
            test::moved({Matrix3d::Identity(), {3, 1, 0.07}}, test::noisyPlane(5, 1000, 0)),
            flat(10), back)
            .distance.max,
        0, 1e-6);
}

TEST(MapErrors, LeavesOutWhatIsBeyondTheReachAndCountsIt)
{
    Points map = test::noisyPlane(5, 1000, 0.01);
    map.push_back({1, 1, 4});
    EXPECT_NEAR(score(map, flat(10)).distance.max, 4, 1e-6);
    MapErrorOptions options;
    options.reach = 1;
    const MapErrors e = score(map, flat(10), options);
    EXPECT_EQ(e.left_out, 1U);
    EXPECT_EQ(e.distance.count, 1000U);
    EXPECT_LT(e.distance.max, 0.1);
}

TEST(MapErrors, AreTheSameBitsWithAnyNumberOfThreads)
{
    const Points map = test::noisyPlane(5, 20'000, 0.05);
    Executor one(1), three(3);
    const MapErrors a = scoreMap(map, flat(5), {}, one), b = scoreMap(map, flat(5), {}, three);
    EXPECT_EQ(a.distance.rmse, b.distance.rmse);
    EXPECT_EQ(a.percentile95, b.percentile95);
    EXPECT_EQ(a.completeness, b.completeness);
    EXPECT_EQ(wallThickness(map, one).median, wallThickness(map, three).median);
    EXPECT_EQ(meanMapEntropy(map, one).mean, meanMapEntropy(map, three).mean);
}

TEST(MapErrors, AgainstACloudAreDistancesToItsPoints)
{
    Points cloud, map;
    test::addLattice(cloud, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 0.04);
    for (const auto& p : cloud)
        if (p.x() < 2) map.push_back(p + Eigen::Vector3f(0, 0, 0.03F));
    const MapErrors e = score(map, cloudOf(cloud));
    EXPECT_NEAR(e.distance.rmse, 0.03, 1e-6);
    EXPECT_NEAR(e.completeness, 0.5, 0.02);
}

TEST(SurfaceAlignment, TakesAShiftedMapBack)
{
    const TrueSurface room(test::boxMesh(kRoom));
    const SurfaceAlignment a =
        alignToSurface(test::moved(kOff, test::boxPoints(kRoom, 0.1)), room, Alignment::SE3);
    const Pose error = a.T_truth_map * kOff;
    EXPECT_LT(error.p.norm(), 1e-4);
    EXPECT_LT(logSO3(error.R).norm(), 1e-4);
    EXPECT_EQ(a.directions, 6);
    EXPECT_EQ(a.near_share, 1);
}

TEST(SurfaceAlignment, IsNotDrawnByWhatTheTruthLacks)
{
    Points map = test::boxPoints(kRoom, 0.1);
    for (float x = 1; x < 5; x += 0.1F)  // a cupboard 25 cm before a wall
        for (float z = 0; z < 2; z += 0.1F) map.push_back({x, 0.25F, z});
    const SurfaceAlignment a =
        alignToSurface(test::moved(kOff, map), TrueSurface(test::boxMesh(kRoom)), Alignment::SE3);
    EXPECT_LT((a.T_truth_map * kOff).p.norm(), 0.005);
}

TEST(SurfaceAlignment, OfYawTurnsAboutZAlone)
{
    const Pose off{expSO3({0, 0, 0.04}), {0.1, 0.1, -0.1}};
    const SurfaceAlignment a = alignToSurface(
        test::moved(off, test::boxPoints(kRoom, 0.1)), TrueSurface(test::boxMesh(kRoom)),
        Alignment::Yaw);
    EXPECT_LT((a.T_truth_map * off).p.norm(), 1e-4);
    EXPECT_NEAR(a.T_truth_map.R(2, 2), 1, 1e-12);
    EXPECT_EQ(a.directions, 4);
}

TEST(SurfaceAlignment, LeavesWhatAPlaneDoesNotShow)
{
    const SurfaceAlignment a = alignToSurface(
        test::moved({Matrix3d::Identity(), {0, 0, 0.2}}, test::noisyPlane(10, 20'000, 0.01)),
        flat(10), Alignment::SE3);
    EXPECT_EQ(a.directions, 3);
    EXPECT_NEAR(a.T_truth_map.p.z(), -0.2, 0.003);
    EXPECT_LT(a.T_truth_map.p.head<2>().norm(), 0.003);
}

TEST(SurfaceAlignment, LaysAMapOnACloud)
{
    const SurfaceAlignment a = alignToSurface(
        test::moved(kOff, test::boxPoints(kRoom, 0.07)), cloudOf(test::boxPoints(kRoom, 0.05)),
        Alignment::SE3);
    const Pose error = a.T_truth_map * kOff;
    EXPECT_LT(error.p.norm(), 0.002);
    EXPECT_LT(logSO3(error.R).norm(), 0.001);
}

TEST(SurfaceAlignment, TellsAMapOfAnotherPlace)
{
    const SurfaceAlignment a = alignToSurface(
        test::moved({Matrix3d::Identity(), {50, 0, 0}}, test::boxPoints(kRoom, 0.1)),
        TrueSurface(test::boxMesh(kRoom)), Alignment::SE3);
    EXPECT_EQ(a.near_share, 0);
}
