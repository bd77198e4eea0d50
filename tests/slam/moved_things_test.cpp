#include "taut/slam/MovedThings.h"

#include <gtest/gtest.h>

#include "taut/graph/SparseGraphOptimizer.h"
#include "taut/places/NearbyPlaces.h"
#include "taut/places/PlacesByView.h"
#include "temporary_folder.h"
#include "walks.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** Walks round the ring in the scene that is there at each metre; keeps each point of the map with
 * the scan that saw it. */
class AWalkAmongThings : public ::testing::Test
{
 protected:
    struct Seen
    {
        Vector3d point;
        Time t;
    };

    void walk(double length, const std::function<Scene(double)>& sceneAt)
    {
        SlamConfig config = slamConfig();
        config.places = Prototype<PlaceRecognizer>(std::make_shared<NearbyPlaces>());
        config.appearance = Prototype<PlaceRecognizer>(std::make_shared<PlacesByView>());
        config.optimizer = Prototype<GraphOptimizer>(std::make_shared<SparseGraphOptimizer>());
        mapper = std::make_unique<Mapper>(config, folder / "submaps", executor, WarningSink());
        Random random(1);
        Time t = 1'700'000'000'000'000'000;
        mapper->start(estimateAt(t, aroundRing(0)));
        for (double s = 0.5; s <= length; s += 0.5)
        {
            const Pose at = aroundRing(s);
            t += fromSeconds(0.5);
            std::vector<Vector3d> points = pointsSeenFrom(sceneAt(s), at, random);
            for (Vector3d& p : points)
            {
                p = at * p;
                seen.push_back({p, t});
            }
            mapper->add(estimateAt(t, at), points, {});
        }
        mapper->finish();
    }

    MovedThings moved()
    {
        MovedThings things(*mapper, executor);
        auto next = seen.begin();
        for (std::size_t position = 0; position < mapper->graph().vertices.size(); position++)
        {
            const auto submap = mapper->submap(mapper->graph().vertices[position].id);
            std::vector<MovedThings::Seen> points;
            for (std::size_t scan = 1; scan < submap->scans.size(); scan++)
                for (; next != seen.end() && next->t == submap->scans[scan].t; ++next)
                    points.push_back({next->point.cast<float>(), static_cast<std::uint16_t>(scan)});
            things.judge(position, points);
        }
        EXPECT_TRUE(next == seen.end());
        return things;
    }

    /** Of the points that are within a box: how many have left. */
    static std::pair<int, int> leftOf(
        const MovedThings& things, const std::vector<Seen>& points, const Box& box)
    {
        int left = 0, all = 0;
        for (const Seen& s : points)
        {
            const bool inside = (s.point.array() >= box.min.array() - 0.05).all() &&
                                (s.point.array() <= box.max.array() + 0.05).all();
            if (!inside) continue;
            all++;
            if (things.haveLeft(s.point)) left++;
        }
        return {left, all};
    }

    TemporaryFolder folder;
    Executor executor{2};
    std::unique_ptr<Mapper> mapper;
    std::vector<Seen> seen;
};
}  // namespace

TEST_F(AWalkAmongThings, ThatAllStayLosesNothing)
{
    walk(150, [](double) { return ring(); });
    const MovedThings things = moved();
    std::size_t left = 0;
    for (const Seen& s : seen)
        if (things.haveLeft(s.point)) left++;
    EXPECT_LT(left, seen.size() / 2000) << "of " << seen.size();
}

TEST_F(AWalkAmongThings, OfWhichOneLeavesFindsIt)
{
    // Stands in the first corridor, and is gone in the second lap.
    const Box visitor{{0, -13.5, 0}, {0.5, -13, 1.8}};
    const Box stays{{-6, -15, 0}, {-4.5, -14, 1.2}};
    walk(
        150,
        [&](double s)
        {
            Scene scene = ring();
            if (s < 60) scene.obstacles.push_back(visitor);
            return scene;
        });
    const MovedThings things = moved();
    const auto [left, all] = leftOf(things, seen, visitor);
    EXPECT_GT(all, 300);
    EXPECT_GT(left, 0.9 * all);
    const auto [wrongly, standing] = leftOf(things, seen, stays);
    EXPECT_GT(standing, 300);
    EXPECT_LT(wrongly, 0.01 * standing);
}

TEST_F(AWalkAmongThings, OfWhichOneArrivesKeepsIt)
{
    const Box visitor{{0, -13.5, 0}, {0.5, -13, 1.8}};
    walk(
        150,
        [&](double s)
        {
            Scene scene = ring();
            if (s > 60) scene.obstacles.push_back(visitor);
            return scene;
        });
    const MovedThings things = moved();
    const auto [left, all] = leftOf(things, seen, visitor);
    EXPECT_GT(all, 300);
    EXPECT_LT(left, 0.02 * all);
}
