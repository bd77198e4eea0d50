#include "taut/render/PointCloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "structures.h"

using namespace taut;

namespace
{
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

double highest(const PointCloud& points)
{
    double z = -1e9;
    for (const auto& p : points) z = std::max(z, static_cast<double>(p.z()));
    return z;
}

/** Points on a plane grid. */
PointCloud plane(int columns, int rows, float spacing)
{
    PointCloud points;
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j)
            points.emplace_back(
                spacing * static_cast<float>(i), spacing * static_cast<float>(j), 0.F);
    return points;
}
}  // namespace

TEST(RobustSpan, LeavesOutTheGivenShareAtBothEnds)
{
    std::vector<double> values{1e9};
    for (int i = 98; i >= 0; --i) values.push_back(i);
    const Span span = robustSpan(values, 0.02);
    EXPECT_EQ(span.low, 2);
    EXPECT_EQ(span.high, 97);
    std::vector<double> none, one{5};
    EXPECT_EQ(robustSpan(none, 0.02).size(), 0);
    EXPECT_EQ(robustSpan(one, 0.02).low, 5);
    EXPECT_EQ(robustSpan(one, 0.02).high, 5);
}

TEST(FinitePoints, DropsWhatIsNotFiniteAndKeepsTheOrder)
{
    const PointCloud kept = finitePoints(
        {{1, 0, 0}, {0, kNan, 0}, {2, 0, 0}, {0, 0, std::numeric_limits<float>::infinity()}});
    ASSERT_EQ(kept.size(), 2U);
    EXPECT_EQ(kept[1].x(), 2);
}

TEST(Thinned, KeepsSmallCloudsAsTheyAre)
{
    const PointCloud points = plane(10, 10, 1);
    EXPECT_EQ(thinned(points, 100), points);
}

TEST(Thinned, HoldsTheCapAndSpreadsEvenlyWhereDensityDiffers)
{
    // 90 % of the points on a tenth of the plane
    test::Random random(3);
    RenderScene scene;
    test::addRectangle(scene, {0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 900, random);
    test::addRectangle(scene, {10, 0, 0}, {90, 0, 0}, {0, 10, 0}, 11, random);
    const PointCloud kept = thinned(scene.points, 5000);
    EXPECT_LE(kept.size(), 5000U);
    EXPECT_GE(kept.size(), 2500U);
    const auto dense = std::count_if(
        kept.begin(), kept.end(), [](const Eigen::Vector3f& p) { return p.x() < 10; });
    EXPECT_LT(static_cast<double>(dense), 0.2 * static_cast<double>(kept.size()));
    EXPECT_EQ(thinned(scene.points, 5000), kept);  // deterministic
}

TEST(Thinned, CopesWithPointsThatAreAllTheSameAndWithFarOutliers)
{
    EXPECT_EQ(thinned(PointCloud(5000, {1, 2, 3}), 1000).size(), 1U);
    PointCloud points = plane(100, 100, 0.1F);
    points.emplace_back(1e30F, -1e30F, 0.F);
    const std::size_t size = thinned(points, 1000).size();
    EXPECT_LE(size, 1000U);
    EXPECT_GE(size, 300U);
}

TEST(WithoutCeiling, OpensAHallAndKeepsItsWallsUpToHalfOfTheClearance)
{
    const RenderScene hall = test::hall();
    const PointCloud open = withoutCeiling(hall.points, hall.trajectory);
    // body at most at 0.2 m, ceiling at 6.8 m
    EXPECT_LT(highest(open), 4.0);
    EXPECT_GT(highest(open), 3.0);
    const auto below = [](const PointCloud& points)
    {
        return std::count_if(
            points.begin(), points.end(), [](const Eigen::Vector3f& p) { return p.z() < 3; });
    };
    EXPECT_EQ(below(open), below(hall.points));
}

TEST(WithoutCeiling, LeavesAStreetWithFacadesAndTreesAlone)
{
    const RenderScene street = test::street();
    EXPECT_EQ(withoutCeiling(street.points, street.trajectory), street.points);
}

TEST(WithoutCeiling, FollowsATunnelThatRises)
{
    test::Random random(4);
    RenderScene tunnel;
    const Vector3d along(100, 0, 30), across(0, 4, 0);
    test::addRectangle(tunnel, {0, -2, 0}, along, across, 20, random);
    test::addRectangle(tunnel, {0, -2, 3}, along, across, 20, random);
    tunnel.trajectory = test::straightPath({0, 0, 1}, {100, 0, 31});
    const PointCloud open = withoutCeiling(tunnel.points, tunnel.trajectory);
    EXPECT_NEAR(
        static_cast<double>(open.size()), static_cast<double>(tunnel.points.size()) / 2, 20);
    for (const auto& p : open) ASSERT_NEAR(p.z(), 0.3 * p.x(), 0.5);
}

TEST(WithoutCeiling, NeedsATrajectoryToTell)
{
    const PointCloud points = plane(10, 10, 1);
    EXPECT_EQ(withoutCeiling(points, {}), points);
    EXPECT_TRUE(withoutCeiling({}, test::straightPath({0, 0, 0}, {1, 0, 0})).empty());
}

TEST(WithoutStrays, DropsLonePointsAndKeepsTheCorners)
{
    PointCloud points = plane(300, 200, 0.1F);
    const std::size_t all = points.size();
    points.emplace_back(100.F, 0.F, 0.F);
    points.emplace_back(0.F, 0.F, -50.F);
    const PointCloud kept = withoutStrays(points);
    EXPECT_EQ(kept.size(), all);
    EXPECT_EQ(kept.back(), points[all - 1]);
    EXPECT_TRUE(withoutStrays({}).empty());
    EXPECT_EQ(withoutStrays({{1, 2, 3}}).size(), 1U);
}

TEST(MeanSpacing, IsThatOfAGrid)
{
    EXPECT_NEAR(meanSpacing(plane(300, 200, 0.1F)), 0.1, 0.015);
    EXPECT_NEAR(meanSpacing(plane(300, 200, 5)), 5, 0.75);
    EXPECT_NEAR(meanSpacing(plane(12, 12, 1)), 1, 0.3);
    EXPECT_EQ(meanSpacing({}), 0);
    EXPECT_EQ(meanSpacing({{1, 2, 3}}), 0);
}
