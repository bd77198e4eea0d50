#include "taut/map/OctreeMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "surfaces.h"

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

Correspondence matchOne(const OctreeMap& map, const Vector3d& query, FeatureKind kind)
{
    Executor executor(1);
    std::vector<Correspondence> found;
    MapScratch scratch;
    map.match({{query, kind}}, found, scratch, executor);
    return found.at(0);
}

void see(OctreeMap& map, const Patch& patch, int scans = 10, unsigned seed = 1)
{
    Random random(seed);
    for (int i = 0; i < scans; i++)
        map.insert(patch.planePoints(random, 2000, FeatureKind::Any), single);
}

Patch floorAt(double height, double noise)
{
    return {{0.3, 0.2, height}, Vector3d::UnitX(), Vector3d::UnitY(), 5, noise};
}
}  // namespace

TEST(OctreeMap, SigmaIsTheThicknessOfTheSurface)
{
    for (const double noise : {0.01, 0.03})
    {
        OctreeMap map;
        const Patch patch = floorAt(1, noise);
        see(map, patch);
        Random random(2);
        double sum = 0;
        for (int i = 0; i < 100; i++)
        {
            const Correspondence c = matchOne(map, patch.at(random, 0.5), FeatureKind::Any);
            ASSERT_EQ(c.surface, Surface::Plane);
            sum += c.sigma / 100;
        }
        EXPECT_NEAR(sum, noise, 0.15 * noise);
    }
}

TEST(OctreeMap, TheConeOfOneRingIsNoSurface)
{
    // A body at rest in a room of 8 x 6 m: the ring that looks up by 9 degrees, seen ten times.
    static constexpr double slope = 0.16;
    const auto onWall = [](double azimuth) -> Vector3d
    {
        const double x = std::cos(azimuth), y = std::sin(azimuth);
        return std::min(4 / std::abs(x), 3 / std::abs(y)) * Vector3d(x, y, slope);
    };
    Random random(5);
    std::vector<MapPoint> points;
    for (int i = 0; i < 10 * 900; i++)
    {
        const Vector3d p = onWall(2 * M_PI * i / 900);
        points.push_back(
            {p + random.vector(0.02).x() * p.normalized(), FeatureKind::Any, -p.normalized()});
    }
    // Had the body risen by 5 cm, the points would be above the cone.
    const auto onTheCone = [&](double min_cosine)
    {
        OctreeMap map;
        map.config.min_cosine = min_cosine;
        map.insert(points, single);
        int matches = 0;
        for (int i = 0; i < 900; i++)
        {
            const Vector3d p = onWall(2 * M_PI * i / 900) + Vector3d(0, 0, 0.05);
            const Correspondence c = matchOne(map, p, FeatureKind::Any);
            if (c.surface == Surface::Plane && std::abs(c.direction.z()) > 0.9) matches++;
        }
        return matches;
    };
    EXPECT_GT(onTheCone(0), 60);
    EXPECT_LT(onTheCone(OctreeMapConfig{}.min_cosine), onTheCone(0) / 3);
}

// Beyond what an integer counts in leaves: for the undefined-behaviour sanitizer.
TEST(OctreeMap, GoesAlongHoweverFarThePoseGoes)
{
    OctreeMap map;
    const Patch patch = floorAt(1, 0.01);
    see(map, patch);
    map.slide({1e12, -1e12, 0});
    EXPECT_EQ(map.size(), 0u);
    map.slide(Vector3d::Zero());
    see(map, patch);
    EXPECT_EQ(matchOne(map, {0.3, 0.2, 1}, FeatureKind::Any).surface, Surface::Plane);
}

TEST(OctreeMap, AThinSurfaceIsNotBelievedToBeThinner)
{
    OctreeMap map;
    see(map, floorAt(1, 0));
    const Correspondence c = matchOne(map, {0.5, 0.5, 1}, FeatureKind::Any);
    ASSERT_EQ(c.surface, Surface::Plane);
    EXPECT_GE(c.sigma, map.config.min_sigma);
    EXPECT_LT(c.sigma, 1.5 * map.config.min_sigma);
}

TEST(OctreeMap, MatchesTheLargestWindowThatIsAsFlatAsTheSmallest)
{
    // In the middle of a large plane the normal comes from a large window: far better than a window
    // of a quarter of a metre could give it.
    OctreeMap map;
    see(map, floorAt(1, 0.02));
    Random random(3);
    int exact = 0;
    for (int i = 0; i < 50; i++)
    {
        const Vector3d query(random.uniform(-2, 2), random.uniform(-2, 2), 1);
        const Correspondence c = matchOne(map, query, FeatureKind::Any);
        ASSERT_EQ(c.surface, Surface::Plane);
        EXPECT_GT(std::abs(c.direction.z()), std::cos(8 * M_PI / 180));
        exact += std::abs(c.direction.z()) > std::cos(0.5 * M_PI / 180);
    }
    EXPECT_GE(exact, 45);  // a few small windows are thinner by chance
}

namespace
{
/** Boards 0.5 m wide, every second one 5 cm higher, along x. */
std::vector<MapPoint> boards(Random& random, int count, double noise)
{
    std::vector<MapPoint> points = floorAt(0, noise).planePoints(random, count, FeatureKind::Any);
    for (MapPoint& p : points)
        if (std::fmod(p.position.x() + 100, 1.0) > 0.5) p.position.z() += 0.05;
    return points;
}

/** Points in the middle of boards. */
std::vector<MapPoint> onBoards(int count, unsigned seed)
{
    Random random(seed);
    std::vector<MapPoint> points = boards(random, 40 * count, 0);
    const auto nearEdge = [](const MapPoint& p)
    {
        const double across = std::fmod(p.position.x() + 100, 0.5);
        return across < 0.2 || across > 0.3 || p.position.head<2>().cwiseAbs().maxCoeff() > 3;
    };
    points.erase(std::remove_if(points.begin(), points.end(), nearEdge), points.end());
    points.resize(static_cast<std::size_t>(count));
    return points;
}

double worstDistance(const OctreeMap& map, const std::vector<MapPoint>& queries)
{
    std::vector<Correspondence> found;
    MapScratch scratch;
    map.match(queries, found, scratch, single);
    double worst = 0;
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        EXPECT_EQ(found[i].surface, Surface::Plane);
        const Vector3d d = queries[i].position - found[i].point;
        worst = std::max(worst, std::abs(found[i].direction.dot(d)));
    }
    return worst;
}
}  // namespace

TEST(OctreeMap, FindsTheScaleBelowOneThatIsAsThickAsTheNext)
{
    // Windows of 1 to 4 m all hold both heights: each is as thick as the larger one.
    OctreeMap map;
    Random random(7);
    for (int scan = 0; scan < 20; scan++) map.insert(boards(random, 20000, 0.005), single);
    EXPECT_LT(worstDistance(map, onBoards(200, 8)), 0.01);
}

TEST(OctreeMap, AsThickAsTheNoiseIsThinEnough)
{
    // Scans of a rough floor, with noise along the rays of a sensor that moves to and fro. A map
    // that gets them all at once is young and searches in full.
    OctreeMap mature, young;
    Random random(5);
    const auto seen = [&](int count, double noise)
    {
        std::vector<MapPoint> points = boards(random, count, 0);
        for (MapPoint& p : points)
        {
            p.view = (Vector3d(random.uniform(-2, 2), 0, 2) - p.position).normalized();
            p.position += noise * random.normal() * p.view;
        }
        return points;
    };
    std::vector<MapPoint> all;
    std::vector<Correspondence> found, searched;
    MapScratch scratch;
    for (int scan = 0; scan < 40; scan++)
    {
        const std::vector<MapPoint> points = seen(1000, 0.01);
        mature.insert(points, single);
        all.insert(all.end(), points.begin(), points.end());
    }
    young.insert(all, single);
    const std::vector<MapPoint> queries = seen(500, 0);
    mature.match(queries, found, scratch, single);
    young.match(queries, searched, scratch, single);
    double error = 0, full_error = 0;
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        ASSERT_EQ(found[i].surface, searched[i].surface);
        const Vector3d& p = queries[i].position;
        error += std::abs(found[i].direction.dot(p - found[i].point));
        full_error += std::abs(searched[i].direction.dot(p - searched[i].point));
    }
    EXPECT_LE(error, 1.02 * full_error);
}

TEST(OctreeMap, LearnsTheNoiseFromWhatIsInserted)
{
    // Where points are few, small windows of a noisy floor look thinner by chance. A map that knows
    // the noise does not look at them.
    OctreeMap mature, young;
    Random random(6);
    for (OctreeMap* map : {&mature, &young}) map->config.dense_points = 1e9;
    std::vector<MapPoint> all;
    for (int scan = 0; scan < 60; scan++)
    {
        std::vector<MapPoint> points = floorAt(0, 0).planePoints(random, 100, FeatureKind::Any);
        for (MapPoint& p : points)
        {
            p.view = (Vector3d(random.uniform(-2, 2), 0, 2) - p.position).normalized();
            p.position += 0.03 * random.normal() * p.view;
        }
        mature.insert(points, single);
        all.insert(all.end(), points.begin(), points.end());
    }
    young.insert(all, single);
    const std::vector<MapPoint> queries(all.begin(), all.begin() + 2000);
    const auto exactIn = [&](const OctreeMap& map)
    {
        std::vector<Correspondence> found;
        MapScratch scratch;
        map.match(queries, found, scratch, single);
        return std::count_if(
            found.begin(), found.end(),
            [](const Correspondence& c)
            { return std::abs(c.direction.z()) > std::cos(0.5 * M_PI / 180); });
    };
    EXPECT_GT(exactIn(mature), 0.995 * 2000);
    EXPECT_LT(exactIn(young), 0.985 * 2000);
}

TEST(OctreeMap, NearAStepSigmaTellsHowFarTheSurfaceMayBe)
{
    OctreeMap step;
    Random random(3);
    Patch left = floorAt(1, 0.01), right = floorAt(1.4, 0.01);
    left.center.x() = -5;
    right.center.x() = 5;
    see(step, left);
    see(step, right, 10, 4);
    int planes = 0;
    for (int i = 0; i < 50; i++)
    {
        const Vector3d query(random.uniform(0.3, 0.6), random.uniform(-2, 2), 1.4);
        const Correspondence c = matchOne(step, query, FeatureKind::Any);
        if (c.surface != Surface::Plane) continue;
        planes++;
        EXPECT_LT(std::abs(c.direction.dot(query - c.point)), 3 * c.sigma);
    }
    EXPECT_GT(planes, 40);
}

TEST(OctreeMap, DoesNotMatchTheTopOfAFloorWithItsUnderside)
{
    // Seen from below on the way up, then from above.
    OctreeMap map;
    Random random(3);
    const Patch underside = floorAt(1, 0.01);
    const auto seenFrom = [](std::vector<MapPoint> points, const Vector3d& sensor)
    {
        for (MapPoint& p : points) p.view = (sensor - p.position).normalized();
        return points;
    };
    for (int scan = 0; scan < 10; scan++)
        map.insert(
            seenFrom(underside.planePoints(random, 2000, FeatureKind::Any), {0, 0, 0}), single);
    std::vector<MapPoint> queries;
    for (int i = 0; i < 100; i++) queries.push_back({underside.at(random, 0.5), FeatureKind::Any});
    const auto planesFrom = [&](const Vector3d& sensor)
    {
        std::vector<Correspondence> found;
        MapScratch scratch;
        map.match(seenFrom(queries, sensor), found, scratch, single);
        return std::count_if(
            found.begin(), found.end(),
            [](const Correspondence& c) { return c.surface == Surface::Plane; });
    };
    EXPECT_EQ(planesFrom({0, 0, 0}), 100);
    EXPECT_EQ(planesFrom({0, 0, 3}), 0);
    EXPECT_EQ(planesFrom({0, 0, 0.5}), 100);
}

TEST(OctreeMap, DoesNotMatchBeyondTheGate)
{
    OctreeMap map;
    map.config.gate = 0.1;
    see(map, floorAt(1, 0.01));
    EXPECT_EQ(matchOne(map, {0.5, 0.5, 1.05}, FeatureKind::Any).surface, Surface::Plane);
    EXPECT_EQ(matchOne(map, {0.5, 0.5, 1.15}, FeatureKind::Any).surface, Surface::None);
}

TEST(OctreeMap, AScatteredCloudIsNoSurface)
{
    OctreeMap map;
    Random random(5);
    std::vector<MapPoint> cloud;
    for (int i = 0; i < 20000; i++)
        cloud.push_back(
            {{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)},
             FeatureKind::Any});
    map.insert(cloud, single);
    int planes = 0;
    for (int i = 0; i < 200; i++)
        planes += matchOne(map, random.vector(1), FeatureKind::Any).surface != Surface::None;
    EXPECT_LT(planes, 10);
}

TEST(OctreeMap, MatchesAWireAsALineIfAskedTo)
{
    const Patch wire = tiltedPatch({1, 2, 3});
    for (const bool lines : {false, true})
    {
        OctreeMap map;
        map.config.lines = lines;
        Random random(6);
        for (int i = 0; i < 10; i++) map.insert(wire.linePoints(random, 200), single);
        int found = 0;
        for (int i = 0; i < 50; i++)
        {
            const Vector3d query = wire.center + random.uniform(-3, 3) * wire.u;
            const Correspondence c = matchOne(map, query, FeatureKind::Edge);
            if (c.surface == Surface::None) continue;
            found++;
            ASSERT_EQ(c.surface, Surface::Line);
            EXPECT_GT(std::abs(c.direction.dot(wire.u)), std::cos(10 * M_PI / 180));
            EXPECT_LT(wire.u.cross(c.point - wire.center).norm(), 0.03);
        }
        if (lines)
            EXPECT_GT(found, 40);
        else
            EXPECT_EQ(found, 0);
    }
}

TEST(OctreeMap, LearnsASurfaceThatIsSeenMoreOften)
{
    OctreeMap map;
    const Patch patch = floorAt(1, 0.01);
    Random random(7);
    map.insert(
        patch.planePoints(random, 5, FeatureKind::Any), single);  // fewer than any window needs
    const auto known = [&]
    {
        int planes = 0;
        Random where(8);
        for (int i = 0; i < 100; i++)
            planes +=
                matchOne(map, patch.at(where, 0.8), FeatureKind::Any).surface == Surface::Plane;
        return planes;
    };
    EXPECT_EQ(known(), 0);
    see(map, patch);
    EXPECT_GT(known(), 95);
}

TEST(OctreeMap, ADenseSurfaceIsFollowedByAShareOfItsPoints)
{
    // A floor that sinks by 1 cm: the mean of all that was seen, however few points are taken.
    OctreeMap all, share;
    all.config.dense_points = 1e9;
    for (OctreeMap* map : {&all, &share})
    {
        see(*map, floorAt(1.01, 0.01), 20, 1);
        see(*map, floorAt(1.00, 0.01), 40, 2);
    }
    Random random(3);
    for (int i = 0; i < 50; i++)
    {
        const Vector3d query = floorAt(1, 0).at(random, 0.5);
        const Correspondence a = matchOne(all, query, FeatureKind::Any);
        const Correspondence b = matchOne(share, query, FeatureKind::Any);
        ASSERT_EQ(a.surface, Surface::Plane);
        ASSERT_EQ(b.surface, Surface::Plane);
        EXPECT_NEAR(a.direction.dot(query - a.point), b.direction.dot(query - b.point), 1.5e-3);
        EXPECT_NEAR(a.sigma, b.sigma, 1e-3);
    }
    EXPECT_EQ(all.size(), share.size());
}

TEST(OctreeMap, ATravelOfManyKilometresHasNoEnd)
{
    // OctoMap's keys reach 4 km from their origin with leaves of 0.125 m.
    OctreeMap map;
    for (double x = 0; x <= 12'000; x += 40)
    {
        map.slide({x, -0.5 * x, 0});
        if (static_cast<int>(x) % 400 != 0) continue;
        Patch patch = floorAt(1, 0.01);
        patch.center += Vector3d(x, -0.5 * x, 0);
        see(map, patch, 3);
        const Correspondence c = matchOne(map, patch.center, FeatureKind::Any);
        ASSERT_EQ(c.surface, Surface::Plane) << x << " m";
        EXPECT_GT(std::abs(c.direction.z()), std::cos(2 * M_PI / 180));
        EXPECT_LT(map.size(), 40'000u);
    }
}

TEST(OctreeMap, KnowsWhatItKnewWhenItsKeysMoveOn)
{
    OctreeMap map;
    map.slide({2040, 0, 0});
    Patch patch = floorAt(1, 0.01);
    patch.center.x() += 2045;
    see(map, patch);
    const std::size_t size = map.size();
    std::vector<MapPoint> queries;
    Random random(9);
    for (int i = 0; i < 100; i++) queries.push_back({patch.at(random, 0.8), FeatureKind::Any});
    Executor executor(1);
    std::vector<Correspondence> before, after;
    MapScratch scratch;
    map.match(queries, before, scratch, executor);
    map.slide({2056, 0, 0});  // beyond half of the keys
    map.match(queries, after, scratch, executor);
    EXPECT_NEAR(static_cast<double>(map.size()), static_cast<double>(size), 20);
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        ASSERT_EQ(before[i].surface, Surface::Plane);
        EXPECT_EQ(after[i].surface, Surface::Plane);
        EXPECT_LT((after[i].direction - before[i].direction).norm(), 1e-6);
        EXPECT_LT((after[i].point - before[i].point).norm(), 1e-6);
        EXPECT_NEAR(after[i].sigma, before[i].sigma, 1e-6);
    }
}
