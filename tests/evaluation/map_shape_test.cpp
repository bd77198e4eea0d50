#include <gtest/gtest.h>

#include "surfaces.h"
#include "taut/evaluation/MapScores.h"

using namespace taut;
using test::Points;

namespace
{
WallThickness walls(const Points& map)
{
    Executor executor(1);
    return wallThickness(map, executor);
}

MapEntropy entropy(const Points& map)
{
    Executor executor(1);
    return meanMapEntropy(map, executor);
}

/** Turned, so that the walls are not along the cells. */
const Pose kAskew{expSO3({0.3, 0.2, 0.5}), {7, -3, 2}};
}  // namespace

TEST(WallThickness, OfANoisyPlaneIsTheNoise)
{
    for (const double sigma : {0.005, 0.02})
        for (const Pose& T : {Pose{}, kAskew})
        {
            const WallThickness w = walls(test::moved(T, test::noisyPlane(10, 50'000, sigma)));
            EXPECT_NEAR(w.median, sigma, 0.03 * sigma);
            EXPECT_GT(w.percentile90, w.median);
            EXPECT_LT(w.percentile90, 1.2 * sigma);
            EXPECT_GT(w.windows, 400U);
            EXPECT_GT(w.planes, w.windows * 9 / 10);
        }
}

TEST(WallThickness, OfAWallSeenTwiceIsHalfTheGap)
{
    Points map;
    test::addLattice(map, {0, 0, 0}, {5, 0, 0}, {0, 5, 0}, 0.04);
    test::addLattice(map, {0, 0, 0.06}, {5, 0, 0}, {0, 5, 0}, 0.04);
    const WallThickness w = walls(test::moved(kAskew, map));
    EXPECT_NEAR(w.median, 0.03, 0.0005);
    EXPECT_NEAR(w.percentile90, 0.03, 0.0015);
}

TEST(WallThickness, LooksAtNoCornersAndNoPipes)
{
    const WallThickness room = walls(test::moved(kAskew, test::boxPoints({6, 5, 3}, 0.04)));
    EXPECT_GT(room.planes, 300U);
    EXPECT_LT(room.median, 1e-5);
    EXPECT_LT(room.percentile90, 0.01) << "at most a strip of the next wall";

    Points pipe;
    for (int i = 0; i < 60; i++)
        for (int z = 0; z < 100; z++)
        {
            const double angle = 2 * M_PI * i / 60;
            pipe.push_back(
                Vector3d(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.04 * z).cast<float>());
        }
    const WallThickness p = walls(pipe);
    EXPECT_GT(p.windows, 20U);
    EXPECT_LT(p.planes, p.windows / 10);
}

TEST(WallThickness, HasNothingToSayOfFewPoints)
{
    const WallThickness w = walls(test::noisyPlane(10, 300, 0.01));
    EXPECT_EQ(w.windows, 0U);
    EXPECT_EQ(w.planes, 0U);
    EXPECT_EQ(w.median, 0);
}

TEST(MapEntropy, OfANoisyPlaneIsThatOfANormalDistribution)
{
    // In a disc of radius r, the variance along each axis is r^2/4.
    const double sigma = 0.005, r = MapEntropy::kRadius;
    const double expected =
        0.5 *
        std::log(std::pow(2 * M_PI * std::exp(1.0), 3) * std::pow(r * r / 4, 2) * square(sigma));
    const MapEntropy once = entropy(test::moved(kAskew, test::noisyPlane(10, 60'000, sigma)));
    EXPECT_EQ(once.points, 60'000U);
    EXPECT_EQ(once.counted, 60'000U);
    EXPECT_NEAR(once.mean, expected, 0.06) << "less at the rim, where a disc is cut";
    const MapEntropy twice = entropy(test::moved(kAskew, test::noisyPlane(10, 60'000, 2 * sigma)));
    EXPECT_NEAR(twice.mean - once.mean, std::log(2), 0.005);
}

TEST(MapEntropy, CountsPointsWithNeighboursAlone)
{
    Points map = test::noisyPlane(1, 2000, 0.01);
    const double mean = entropy(map).mean;
    map.push_back({50, 50, 50});
    const MapEntropy e = entropy(map);
    EXPECT_EQ(e.points, 2001U);
    EXPECT_EQ(e.counted, 2000U);
    EXPECT_NEAR(e.mean, mean, 1e-12);
    EXPECT_TRUE(std::isfinite(entropy(Points(100, Eigen::Vector3f(1, 1, 1))).mean));
}
