#include "taut/map/KdTreeMap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "surfaces.h"

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

Correspondence matchOne(const KdTreeMap& map, const Vector3d& position, FeatureKind kind)
{
    Executor executor;
    std::vector<Correspondence> found;
    MapScratch scratch;
    map.match({{position, kind}}, found, scratch, executor);
    return found.at(0);
}
}  // namespace

TEST(KdTreeMap, MatchesAnEdgeWithItsLine)
{
    Patch line = tiltedPatch({2, -1, 0.5});
    line.radius = 3;
    Random random(1);
    KdTreeMap map;
    for (int scan = 0; scan < 5; scan++) map.insert(line.linePoints(random, 100), single);
    for (int i = 0; i < 50; i++)
    {
        const Vector3d query = line.center + random.uniform(-2, 2) * line.u + random.vector(0.1);
        const Correspondence c = matchOne(map, query, FeatureKind::Edge);
        ASSERT_EQ(c.surface, Surface::Line);
        EXPECT_GT(std::abs(c.direction.dot(line.u)), std::cos(5 * M_PI / 180));
        EXPECT_LT(line.u.cross(c.point - line.center).norm(), 0.02);
        EXPECT_GT(c.sigma, 0);
        EXPECT_LT(c.sigma, 0.03);
    }
}

TEST(KdTreeMap, MakesNoLineOfACross)
{
    KdTreeMap map;
    std::vector<MapPoint> points;
    for (int i = -2; i <= 2; i++)
    {
        points.push_back({{0.21 * i, 0, 0}, FeatureKind::Edge});
        points.push_back({{0, 0.21 * i, 0}, FeatureKind::Edge});
    }
    map.insert(points, single);
    EXPECT_EQ(matchOne(map, {0, 0, 0}, FeatureKind::Edge).surface, Surface::None);
}

TEST(KdTreeMap, MakesNoPlaneOfPointsInOneRow)
{
    Random random(1);
    KdTreeMap map;
    for (int i = 0; i < 800; i++)
        map.insert({{Vector3d(0.05 * i, 0, 0) + random.vector(0.01), FeatureKind::Plane}}, single);
    for (int i = 2; i < 38; i++)
        EXPECT_EQ(matchOne(map, Vector3d(i, 0, 0), FeatureKind::Plane).surface, Surface::None);
}

TEST(KdTreeMap, ThinksLittleOfPlanesThroughScatteredPoints)
{
    Random random(1);
    KdTreeMap map;
    std::vector<MapPoint> points;
    for (int i = 0; i < 3000; i++)
        points.push_back(
            {{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)},
             FeatureKind::Any});
    map.insert(points, single);
    int trusted = 0;
    for (int i = 0; i < 200; i++)
    {
        const Correspondence c = matchOne(map, random.vector(1), FeatureKind::Any);
        trusted += c.surface == Surface::Plane && c.sigma < 0.03;
    }
    EXPECT_LT(trusted, 40) << "of 200";
}

TEST(KdTreeMap, KnowsLessAboutAPlaneBesideItsPoints)
{
    Patch patch = tiltedPatch(Vector3d::Zero());
    patch.radius = 1;
    Random random(2);
    double inside = 0, beside = 0;
    for (int i = 0; i < 40; i++)
    {
        KdTreeMap map;
        map.insert(patch.planePoints(random, 300, FeatureKind::Plane), single);
        const auto in = matchOne(map, patch.center, FeatureKind::Plane);
        const auto out = matchOne(map, patch.center + 1.4 * patch.u, FeatureKind::Plane);
        ASSERT_EQ(in.surface, Surface::Plane);
        if (out.surface == Surface::None) continue;  // its neighbours make a row
        inside += in.sigma;
        beside += out.sigma;
    }
    EXPECT_GT(beside, 2 * inside);
}

TEST(VoxelForest, FindsTheSameNeighboursAsASearchOfAll)
{
    Random random(6);
    VoxelForest forest(0.1, 1);  // one point a voxel: what is returned is what was searched
    std::vector<Vector3d> all;
    for (int batch = 0; batch < 30; batch++)
    {
        std::vector<Vector3d> points;
        for (int i = 0; i < 50 + batch % 7 * 40; i++) points.push_back(random.vector(2));
        forest.insert(points);
    }
    for (std::uint32_t i = 0; i < forest.size(); i++) all.push_back(forest.mean(i));
    ASSERT_GT(all.size(), 3000u);

    for (int i = 0; i < 200; i++)
    {
        const Vector3d query = random.vector(2);
        const double radius = i % 2 ? 0.2 : 5;
        std::vector<double> expected;
        for (const Vector3d& p : all)
            if ((p - query).norm() < radius) expected.push_back((p - query).norm());
        std::sort(expected.begin(), expected.end());
        expected.resize(std::min<std::size_t>(expected.size(), 5));
        const Neighbours found = forest.nearest(query, 5, radius);
        ASSERT_EQ(found.count, expected.size());
        for (std::size_t k = 0; k < found.count; k++)
            EXPECT_NEAR((forest.mean(found.cells[k]) - query).norm(), expected[k], 1e-5);
    }
}

TEST(VoxelForest, KeepsTheMeanOfTheFirstPointsOfAVoxel)
{
    VoxelForest forest(1.0, 3);
    forest.insert({{0.1, 0.5, 0.5}, {0.2, 0.5, 0.5}});
    forest.insert({{0.3, 0.5, 0.5}, {0.9, 0.5, 0.5}, {1.5, 0.5, 0.5}});
    ASSERT_EQ(forest.size(), 2u);
    EXPECT_NEAR(forest.mean(0).x(), 0.2, 1e-12);
    EXPECT_NEAR(forest.mean(1).x(), 1.5, 1e-12);
}

TEST(VoxelForest, FindsWhatIsLeftAfterItsBoxMoved)
{
    Random random(6);
    VoxelForest forest(0.2);
    std::vector<Vector3d> points;
    for (int i = 0; i < 2000; i++) points.push_back(random.vector(3));
    forest.insert(points);
    forest.keepBox({1, 0, 0}, 2);
    for (std::uint32_t i = 0; i < forest.size(); i++)
        EXPECT_LE((forest.mean(i) - Vector3d(1, 0, 0)).cwiseAbs().maxCoeff(), 2);
    EXPECT_GT(forest.size(), 200u);
    EXPECT_EQ(forest.nearest({1, 0, 0}, 5, 2).count, 5u);
    EXPECT_EQ(forest.nearest({-4, 0, 0}, 5, 2).count, 0u);
    const std::size_t before = forest.size();
    forest.insert(points);  // known voxels are known still, forgotten ones new
    EXPECT_GT(forest.size(), before);
    EXPECT_EQ(forest.nearest({-4, 0, 0}, 5, 2).count, 5u);
}
