/** \file
 * What every map must do: add a class name below to hold another one to it. */
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "surfaces.h"
#include "taut/core/Plugins.h"
#include "taut/map/Register.h"

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class AnyMap : public ::testing::TestWithParam<const char*>
{
 protected:
    void SetUp() override
    {
        registerMaps();
        map = make();
    }

    std::shared_ptr<Map> make(const std::string& yaml = "{}") const
    {
        ConfigSection section(parseYaml(yaml), "map");
        auto created = createPlugin<Map>(GetParam());
        created->configure(section);
        section.rejectUnknown();
        return created;
    }

    /** Several scans of a patch. */
    static void see(Map& seen_by, const Patch& patch, FeatureKind kind = FeatureKind::Plane)
    {
        Random random(3);
        for (int scan = 0; scan < 10; scan++)
            seen_by.insert(patch.planePoints(random, 1000, kind), single);
    }

    static std::vector<MapPoint> queriesOn(const Patch& patch, FeatureKind kind, int count = 300)
    {
        Random random(5);
        std::vector<MapPoint> queries;
        for (int i = 0; i < count; i++)
            queries.push_back(
                {patch.at(random, 0.8) + random.uniform(-0.1, 0.1) * patch.normal(), kind});
        return queries;
    }

    static std::vector<Correspondence> match(
        const Map& in, const std::vector<MapPoint>& queries, int threads = 1)
    {
        Executor executor(threads);
        std::vector<Correspondence> correspondences(3);  // not empty: must be replaced
        MapScratch scratch;
        in.match(queries, correspondences, scratch, executor);
        EXPECT_EQ(correspondences.size(), queries.size());
        return correspondences;
    }

    /** Scans of a stepped floor and of a rougher one beside it, with noise along the rays. */
    static void grow(Map& map, int scans)
    {
        Random random(11);
        for (int scan = 0; scan < scans; scan++) map.insert(scanOfFloors(random), single);
    }

    static std::vector<MapPoint> scanOfFloors(Random& random)
    {
        std::vector<MapPoint> points = onFloor(random, 0, 1500, 0.005);
        const std::vector<MapPoint> rough = onFloor(random, kRoughFloor, 1500, 0.03);
        points.insert(points.end(), rough.begin(), rough.end());
        return points;
    }

    /** Points of steps 5 cm high, seen by a sensor that moves to and fro above them. */
    static std::vector<MapPoint> onFloor(Random& random, double x, int count, double noise)
    {
        const Patch floor{{x, 0, 0}, Vector3d::UnitX(), Vector3d::UnitY(), 4, 0};
        std::vector<MapPoint> points = floor.planePoints(random, count, FeatureKind::Plane);
        for (MapPoint& p : points)
        {
            if (std::fmod(p.position.x() + 100, 1.4) > 0.7) p.position.z() += 0.05;
            const Vector3d sensor(x + random.uniform(-3, 3), 0, 1.5);
            p.view = (sensor - p.position).normalized();
            p.position += noise * random.normal() * p.view;
        }
        return points;
    }

    /** The queries of a later iteration: moved and turned a little. */
    static std::vector<MapPoint> moved(std::vector<MapPoint> queries, double by)
    {
        for (MapPoint& q : queries)
        {
            q.position += by * Vector3d(0.3, 0.2, 0.1);
            q.view = (q.view + by * Vector3d(0.2, -0.4, 0.1)).normalized();
        }
        return queries;
    }

    static void expectSame(
        const std::vector<Correspondence>& one, const std::vector<Correspondence>& other)
    {
        ASSERT_EQ(one.size(), other.size());
        for (std::size_t i = 0; i < one.size(); i++)
        {
            ASSERT_EQ(one[i].surface, other[i].surface) << i;
            ASSERT_EQ(one[i].direction, other[i].direction) << i;
            ASSERT_EQ(one[i].point, other[i].point) << i;
            ASSERT_EQ(one[i].sigma, other[i].sigma) << i;
        }
    }

    static int planesIn(const std::vector<Correspondence>& found)
    {
        return static_cast<int>(std::count_if(
            found.begin(), found.end(),
            [](const Correspondence& c) { return c.surface == Surface::Plane; }));
    }

    std::shared_ptr<Map> copyOf(const Map& of) const
    {
        return std::dynamic_pointer_cast<Map>(of.duplicateGetSmartPtr());
    }

    static constexpr int kYoung = 20,
                         kOld = 40;            // scans; a map that learns has learnt when it is old
    static constexpr double kRoughFloor = 10;  // [m], x of its middle

    static void expectOnPlane(const std::vector<Correspondence>& found, const Patch& patch)
    {
        int planes = 0, right = 0;
        for (const Correspondence& c : found)
        {
            if (c.surface == Surface::None) continue;
            ASSERT_EQ(c.surface, Surface::Plane);
            planes++;
            EXPECT_NEAR(c.direction.norm(), 1, 1e-9);
            EXPECT_TRUE(std::isfinite(c.sigma));
            EXPECT_GE(c.sigma, 0);
            EXPECT_LT(c.sigma, 0.1);
            const double cosine = std::abs(c.direction.dot(patch.normal()));
            const double off = std::abs(patch.normal().dot(c.point - patch.center));
            right += cosine > std::cos(6 * M_PI / 180) && off < 0.03;
        }
        EXPECT_GT(planes, 0.9 * static_cast<double>(found.size()));
        EXPECT_GT(right, 0.95 * planes);
    }

    std::shared_ptr<Map> map;
};
}  // namespace

TEST_P(AnyMap, IsEmptyAtFirstAndMatchesNothing)
{
    EXPECT_TRUE(map->empty());
    EXPECT_EQ(map->size(), 0u);
    const Patch patch = tiltedPatch(Vector3d::Zero());
    for (const FeatureKind kind : {FeatureKind::Plane, FeatureKind::Edge, FeatureKind::Any})
        for (const Correspondence& c : match(*map, queriesOn(patch, kind)))
            EXPECT_EQ(c.surface, Surface::None);
    EXPECT_TRUE(match(*map, {}).empty());
    map->slide(Vector3d::Zero());
    map->clear();
    EXPECT_TRUE(map->empty());
}

TEST_P(AnyMap, MatchesANoisyPlaneWithItsNormal)
{
    for (const FeatureKind kind : {FeatureKind::Plane, FeatureKind::Any})
    {
        map->clear();
        const Patch patch = tiltedPatch({2, -1, 0.5});
        see(*map, patch, kind);
        EXPECT_FALSE(map->empty());
        expectOnPlane(match(*map, queriesOn(patch, kind)), patch);
    }
}

TEST_P(AnyMap, IsAsExactFarFromTheOriginOfTheWorld)
{
    const Patch patch = tiltedPatch({5000, -3000, 200});
    map->slide(patch.center);
    see(*map, patch);
    expectOnPlane(match(*map, queriesOn(patch, FeatureKind::Plane)), patch);
}

TEST_P(AnyMap, MatchesNothingFarFromItsPoints)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    see(*map, patch);
    for (const FeatureKind kind : {FeatureKind::Plane, FeatureKind::Edge, FeatureKind::Any})
        for (const double distance : {5.0, -12.0, 1e7})
        {
            Patch far = patch;
            far.center += distance * patch.normal();
            for (const Correspondence& c : match(*map, queriesOn(far, kind)))
                EXPECT_EQ(c.surface, Surface::None);
        }
}

TEST_P(AnyMap, MatchesPlanarQueriesWithPlanesAndEdgesWithLines)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    see(*map, patch);
    Random random(4);
    for (int scan = 0; scan < 10; scan++) map->insert(patch.linePoints(random, 100), single);
    for (const Correspondence& c : match(*map, queriesOn(patch, FeatureKind::Plane)))
        EXPECT_NE(c.surface, Surface::Line);
    for (const Correspondence& c : match(*map, queriesOn(patch, FeatureKind::Edge)))
        EXPECT_NE(c.surface, Surface::Plane);
}

TEST_P(AnyMap, GivesTheSameWithAnyNumberOfThreads)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    see(*map, patch);
    const auto queries = queriesOn(patch, FeatureKind::Any, 3000);
    const auto one = match(*map, queries, 1);
    for (const int threads : {2, 5}) expectSame(one, match(*map, queries, threads));
}

TEST_P(AnyMap, GrowsOldTheSameWithAnyNumberOfThreads)
{
    const auto other = make();
    Random random(11);
    Executor many(3);
    MapScratch scratch, scratch_of_many;
    std::vector<Correspondence> found, found_by_many;
    for (int scan = 0; scan < kOld; scan++)
    {
        const auto points = scanOfFloors(random);
        map->insert(points, single);
        other->insert(points, many);
        map->match(points, found, scratch, single);
        other->match(points, found_by_many, scratch_of_many, many);
        expectSame(found, found_by_many);
        map->keep(scratch);
        other->keep(scratch_of_many);
    }
    EXPECT_GT(planesIn(found), 2000);
}

TEST_P(AnyMap, AnswersWhateverWasAskedBefore)
{
    for (const int scans : {kYoung, kOld})
    {
        map->clear();
        grow(*map, scans);
        const auto untouched = copyOf(*map);
        Random random(12);
        const auto before = onFloor(random, kRoughFloor, 500, 0.1);
        const auto queries = onFloor(random, 0, 500, 0);
        MapScratch scratch;
        std::vector<Correspondence> found;
        for (int round = 0; round < 3; round++)
        {
            map->match(before, found, scratch, single);
            map->match(moved(queries, 1), found, scratch, single);
            map->match(queries, found, scratch, single);
            const auto alone = match(*untouched, queries);
            expectSame(found, alone);
            EXPECT_GT(planesIn(alone), 400);
            // What was asked has no part in what the map becomes.
            const auto more = scanOfFloors(random);
            map->insert(more, single);
            untouched->insert(more, single);
        }
    }
}

TEST_P(AnyMap, AScratchThatIsUsedAgainChangesNothing)
{
    grow(*map, kOld);
    Random random(13);
    auto queries = scanOfFloors(random);
    const std::size_t seen_from_above = queries.size();
    for (std::size_t i = 0; i < seen_from_above; i += 3)
    {
        queries.push_back(queries[i]);  // once more with a grazing view, near to the other side
        queries.back().view = Vector3d(1, 0, random.uniform(-0.03, 0.03)).normalized();
    }
    MapScratch scratch;
    std::vector<Correspondence> found;
    for (int iteration = 0; iteration < 30; iteration++)
    {
        map->match(queries, found, scratch, single);
        expectSame(found, match(*map, queries));
        queries = moved(queries, iteration % 3 == 0 ? 0.03 : 0.002);
    }
    const auto other = make();
    see(*other, tiltedPatch({2, -1, 0.5}));
    for (Map* next : {other.get(), map.get()})
    {
        next->match(queries, found, scratch, single);
        expectSame(found, match(*next, queries));
    }
}

TEST_P(AnyMap, KeepingChangesNoAnswerBeforeTheNextInsertion)
{
    grow(*map, kOld);
    Random random(14);
    const auto queries = scanOfFloors(random);
    MapScratch first, second;
    std::vector<Correspondence> before, after;
    map->match(queries, before, first, single);
    map->match(moved(queries, 0.1), after, second, single);
    map->keep(first);
    expectSame(before, match(*map, queries));
    for (MapScratch* scratch : {&first, &second})
    {
        map->match(queries, after, *scratch, single);
        expectSame(before, after);
        map->keep(*scratch);
    }
    expectSame(before, match(*map, queries));
}

TEST_P(AnyMap, KeepsNothingOfAMapThatHasChangedSince)
{
    grow(*map, kYoung);
    const auto untouched = copyOf(*map);
    Random random(17);
    const auto queries = scanOfFloors(random), more = scanOfFloors(random);
    MapScratch scratch;
    std::vector<Correspondence> found;
    map->match(queries, found, scratch, single);
    for (Map* m : {map.get(), untouched.get()}) m->insert(more, single);
    map->keep(scratch);
    expectSame(match(*map, queries), match(*untouched, queries));

    map->match(queries, found, scratch, single);
    map->slide({1000, 0, 0});
    map->keep(scratch);
    EXPECT_EQ(planesIn(match(*map, queries)), 0);
    grow(*map, kYoung);
    map->match(queries, found, scratch, single);
    expectSame(found, match(*map, queries));
}

TEST_P(AnyMap, AnswersTwoThreadsAtOnceAsOneAfterTheOther)
{
    grow(*map, kOld);
    Random random(15);
    const Map& shared = *map;
    const std::vector<MapPoint> queries[] = {
        scanOfFloors(random), onFloor(random, kRoughFloor, 3000, 0.05)};
    constexpr int kIterations = 20;
    std::vector<Correspondence> found[2][kIterations];
    const auto ask = [&](int which)
    {
        Executor executor(2);
        MapScratch scratch;
        for (int i = 0; i < kIterations; i++)
            shared.match(moved(queries[which], 0.01 * i), found[which][i], scratch, executor);
    };
    std::thread one(ask, 0), other(ask, 1);
    one.join();
    other.join();
    for (int which = 0; which < 2; which++)
        for (int i = 0; i < kIterations; i++)
            expectSame(found[which][i], match(shared, moved(queries[which], 0.01 * i)));
}

TEST_P(AnyMap, ACopyAnswersAsItsOriginal)
{
    grow(*map, kOld);
    const auto copy = copyOf(*map);
    Random random(16);
    const auto queries = scanOfFloors(random);
    expectSame(match(*map, queries), match(*copy, queries));
    for (int scan = 0; scan < 3; scan++)
    {
        const auto more = scanOfFloors(random);
        map->insert(more, single);
        copy->insert(more, single);
        expectSame(match(*map, queries), match(*copy, queries));
    }
}

TEST_P(AnyMap, GivesTheSameForTheSameInsertions)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    const auto other = make();
    for (Map* m : {map.get(), other.get()})
    {
        see(*m, patch);
        m->slide(patch.center);
        see(*m, tiltedPatch({4, 3, 0}));
    }
    EXPECT_EQ(map->size(), other->size());
    const auto queries = queriesOn(patch, FeatureKind::Any);
    const auto a = match(*map, queries), b = match(*other, queries);
    for (std::size_t i = 0; i < a.size(); i++)
    {
        EXPECT_EQ(a[i].surface, b[i].surface);
        EXPECT_EQ(a[i].direction, b[i].direction);
        EXPECT_EQ(a[i].point, b[i].point);
    }
}

TEST_P(AnyMap, HoldsNoMoreForPointsSeenAgain)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    for (int i = 0; i < 5; i++) see(*map, patch);
    const std::size_t before = map->size();
    for (int i = 0; i < 20; i++) see(*map, patch);
    EXPECT_LE(map->size(), before + before / 10);
}

TEST_P(AnyMap, ForgetsWhatLeavesTheWindow)
{
    map = make("window_radius: 20");
    std::size_t most = 0;
    for (int i = 0; i <= 100; i++)
    {
        const Patch patch = tiltedPatch({5.0 * i, 0, 0});
        map->slide(patch.center);
        see(*map, patch);
        if (i <= 20) most = std::max(most, map->size());
    }
    EXPECT_LE(map->size(), most + most / 10);
    const Patch first = tiltedPatch({0, 0, 0}), last = tiltedPatch({500, 0, 0});
    for (const Correspondence& c : match(*map, queriesOn(first, FeatureKind::Plane)))
        EXPECT_EQ(c.surface, Surface::None);
    expectOnPlane(match(*map, queriesOn(last, FeatureKind::Plane)), last);

    map->slide({-1000, 0, 0});
    EXPECT_TRUE(map->empty());
}

TEST_P(AnyMap, ClearsAndLearnsAgain)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    see(*map, patch);
    const std::size_t size = map->size();
    map->clear();
    EXPECT_TRUE(map->empty());
    EXPECT_EQ(map->size(), 0u);
    for (const Correspondence& c : match(*map, queriesOn(patch, FeatureKind::Plane)))
        EXPECT_EQ(c.surface, Surface::None);
    see(*map, patch);
    EXPECT_EQ(map->size(), size);
}

TEST_P(AnyMap, IgnoresPointsThatAreNotFinite)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    map->insert({{{kNaN, 0, 0}, FeatureKind::Plane}, {{0, 1 / 0.0, 0}, FeatureKind::Edge}}, single);
    EXPECT_TRUE(map->empty());
    see(*map, patch);
    EXPECT_EQ(
        match(*map, {{{0, kNaN, 0}, FeatureKind::Plane}, {{kNaN, 0, 0}, FeatureKind::Edge}})[0]
            .surface,
        Surface::None);
    expectOnPlane(match(*map, queriesOn(patch, FeatureKind::Plane)), patch);
}

TEST_P(AnyMap, CopiesAreIndependent)
{
    const Patch patch = tiltedPatch({2, -1, 0.5});
    see(*map, patch);
    const auto copy = std::dynamic_pointer_cast<Map>(map->duplicateGetSmartPtr());
    ASSERT_TRUE(copy);
    map->clear();
    EXPECT_FALSE(copy->empty());
    expectOnPlane(match(*copy, queriesOn(patch, FeatureKind::Plane)), patch);
}

TEST_P(AnyMap, RejectsAWindowOfNoSize)
{
    EXPECT_THROW(make("window_radius: 0"), ConfigError);
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyMap, ::testing::Values("taut::KdTreeMap", "taut::OctreeMap"),
    [](const auto& test) { return std::string(test.param).substr(6); });
