#include <gtest/gtest.h>

#include "taut/places/PlacesByView.h"
#include "walks.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** Submaps of the ring, each turned and moved by itself, as parts that nothing joins. */
class ViewsOfTheRing : public ::testing::Test
{
 protected:
    static Pose aside(VertexId id)
    {
        return {
            expSO3({0, 0, 1.3 * static_cast<double>(id)}), {7.0 * static_cast<double>(id), -3, 0}};
    }

    void add(double from, bool opposite = false)
    {
        const auto back = [](double way)
        {
            Pose pose = aroundRing(200 - way);
            pose.R = pose.R * expSO3({0, 0, M_PI});
            return pose;
        };
        Submap s = opposite
                       ? submapOf(ring(), back, 200 - from - 14, 14, 7)
                       : submapOf(ring(), aroundRing, from, 14, 3 + static_cast<unsigned>(from));
        s.id = static_cast<VertexId>(truth.size());
        truth.push_back(s.T_world_submap);
        places.add(s);
    }

    /** How far off the best of the candidates of the last submap is [m]: the first of them, or
     * any. */
    double distance(bool any) const
    {
        const PlaceKnowledge knowledge{
            [](VertexId id) { return aside(id); },
            [](VertexId, VertexId) { return std::optional<Matrix6d>(); }};
        const auto found = places.candidates(static_cast<VertexId>(truth.size()) - 1, knowledge);
        double nearest = 1e9;
        for (const LoopCandidate& c : found)
        {
            const Pose true_pose = truth[static_cast<std::size_t>(c.from)].inverse() *
                                   truth[static_cast<std::size_t>(c.to)];
            nearest = std::min(nearest, (true_pose.p - c.T_from_to.p).norm());
            if (!any) break;
        }
        return nearest;
    }

    PlacesByView places;
    std::vector<Pose> truth;
};
}  // namespace

TEST_F(ViewsOfTheRing, AreRecognisedWithoutAGuess)
{
    for (const double from : {0.0, 15.0, 33.0, 50.0, 68.0, 85.0, 100.0}) add(from);
    int right = 0, asked = 0;
    for (const double from : {2.0, 17.0, 36.0, 52.0, 70.0, 83.0, 102.0})
    {
        add(from);
        asked++;
        right += distance(false) < 1.5;
    }
    EXPECT_GE(right, asked - 1);
}

TEST_F(ViewsOfTheRing, AreRecognisedInTheOppositeDirection)
{
    for (const double from : {0.0, 20.0, 45.0, 70.0, 95.0}) add(from);
    add(22, true);
    // The ring looks nearly the same when it is turned by half: the judge tells them apart.
    EXPECT_LT(distance(true), 1.5);
}

TEST_F(ViewsOfTheRing, AreNotAskedForWhereTheGraphIsSure)
{
    add(0);
    add(1);
    const PlaceKnowledge knowledge{
        [](VertexId id) { return aside(id); },
        [](VertexId, VertexId) { return std::optional(Matrix6d(1e-2 * Matrix6d::Identity())); }};
    EXPECT_TRUE(places.candidates(1, knowledge).empty());
}

TEST(AViewFromAbove, OfAPlaneFieldTellsNothing)
{
    Submap field;
    field.scans.resize(1);
    Random random(1);
    for (int i = 0; i < 5000; i++)
        field.points.push_back(
            {Eigen::Vector3f(
                 static_cast<float>(random.uniform(-30, 30)),
                 static_cast<float>(random.uniform(-30, 30)), 0),
             0});
    EXPECT_TRUE(ViewFromAbove::of(field).cells.empty());
    EXPECT_TRUE(matchViews(ViewFromAbove::of(field), ViewFromAbove::of(field), 3).empty());
}
