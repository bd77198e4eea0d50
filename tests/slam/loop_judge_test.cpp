#include "taut/loops/LoopJudge.h"

#include <gtest/gtest.h>

#include "taut/loops/SubmapRegistration.h"
#include "walks.h"

using namespace taut;
using namespace taut::test;

namespace
{
SubmapView viewOf(const Submap& submap)
{
    auto map = std::make_shared<OctreeMap>();
    Executor executor;
    map->insert(mapPointsOf(submap, submap.points.size()), executor);
    return {std::make_shared<Submap>(submap), map};
}

LoopCandidate candidate(const Pose& guess, double sigma = 0.2)
{
    LoopCandidate c;
    c.from = 0;
    c.to = 1;
    c.T_from_to = guess;
    c.covariance = square(sigma) * Matrix6d::Identity();
    c.covariance.bottomRightCorner<3, 3>() *= 0.01;
    return c;
}

/** A hall; the things in it differ from one number to the next. */
Scene hall(int number)
{
    Scene scene;
    scene.room = {{-8, -6, 0}, {8, 6, 4}};
    Random random(static_cast<unsigned>(number));
    for (int i = 0; i < 6; i++)
    {
        const double x = random.uniform(-7, 6), y = random.uniform(2, 5) * (i % 2 == 0 ? 1 : -1);
        scene.obstacles.push_back({{x, y - 0.5, 0}, {x + 1, y + 0.5, random.uniform(1, 3)}});
    }
    return scene;
}

Pose alongHall(double way)
{
    return {Matrix3d::Identity(), {-5 + way, 0, 1.2}};
}

LoopClosure judgeLoop(const Submap& a, const Submap& b, const LoopCandidate& c)
{
    Executor executor;
    return LoopJudge({}, executor).judge(c, viewOf(a), viewOf(b));
}
}  // namespace

TEST(ALoop, ThroughOnePlaceIsFoundAndPlaced)
{
    const Submap a = submapOf(ring(), aroundRing, 10, 15, 1);
    const Submap b = submapOf(ring(), aroundRing, 12, 15, 2);
    const Pose truth = a.T_world_submap.inverse() * b.T_world_submap;
    const Pose guess = truth * Pose{expSO3({0, 0, 0.03}), {0.3, -0.3, 0.1}};
    const LoopClosure loop = judgeLoop(a, b, candidate(guess));
    EXPECT_EQ(loop.verdict, Verdict::Pending) << loop.reason;
    EXPECT_LT((loop.T_from_to.p - truth.p).norm(), 0.01);
    EXPECT_GT(loop.evidence.inliers, 0.8);
    EXPECT_LT(loop.evidence.conflicts, 0.02);
}

TEST(ALoop, InTheOppositeDirectionIsFound)
{
    const auto back = [](double way)
    {
        Pose pose = aroundRing(30 - way);
        pose.R = pose.R * expSO3({0, 0, M_PI});
        return pose;
    };
    const Submap a = submapOf(ring(), aroundRing, 10, 15, 1);
    const Submap b = submapOf(ring(), back, 2, 15, 2);
    const Pose truth = a.T_world_submap.inverse() * b.T_world_submap;
    const LoopClosure loop = judgeLoop(a, b, candidate(truth));
    EXPECT_EQ(loop.verdict, Verdict::Pending) << loop.reason;
    EXPECT_LT((loop.T_from_to.p - truth.p).norm(), 0.01);
}

TEST(ALoop, IsFoundFromFarAsideWhereTheGraphIsUnsure)
{
    const Submap a = submapOf(ring(), aroundRing, 25, 20, 1);
    const Submap b = submapOf(ring(), aroundRing, 27, 20, 2);
    const Pose truth = a.T_world_submap.inverse() * b.T_world_submap;
    const Pose guess = truth * Pose{expSO3({0, 0, 0.1}), {1.6, -1.2, 0.2}};
    const LoopClosure loop = judgeLoop(a, b, candidate(guess, 1.5));
    EXPECT_EQ(loop.verdict, Verdict::Pending) << loop.reason;
    EXPECT_LT((loop.T_from_to.p - truth.p).norm(), 0.01);
}

TEST(ALoop, BetweenHallsOfOneShapeIsNeverBelieved)
{
    // Each has other things in it: where one has a box, the other saw through.
    int believed = 0;
    for (int i = 1; i <= 12; i++)
    {
        const Submap a = submapOf(hall(i), alongHall, 0, 9, 1);
        const Submap b = submapOf(hall(i + 20), alongHall, 0.5, 9, 2);
        const LoopClosure loop = judgeLoop(a, b, candidate({Matrix3d::Identity(), {0.5, 0, 0}}));
        believed += loop.verdict == Verdict::Pending;
        RecordProperty("conflicts" + std::to_string(i), std::to_string(loop.evidence.conflicts));
    }
    EXPECT_EQ(believed, 0);
}

TEST(ALoop, InOneHallIsBelieved)
{
    for (int i = 1; i <= 12; i++)
    {
        const Submap a = submapOf(hall(i), alongHall, 0, 9, 1);
        const Submap b = submapOf(hall(i), alongHall, 0.5, 9, 2);
        const LoopClosure loop = judgeLoop(a, b, candidate({Matrix3d::Identity(), {0.6, 0.1, 0}}));
        EXPECT_EQ(loop.verdict, Verdict::Pending) << loop.reason;
        EXPECT_EQ(loop.evidence.directions, 6);
        RecordProperty("conflicts" + std::to_string(i), std::to_string(loop.evidence.conflicts));
    }
}

TEST(ALoop, InAPlainCorridorTiesAcrossAndNotAlong)
{
    Scene corridor;
    corridor.room = {{-400, -1.2, 0}, {400, 1.2, 2.6}};
    const auto along = [](double way) { return Pose{Matrix3d::Identity(), {way, 0, 1.2}}; };
    const Submap a = submapOf(corridor, along, 0, 10, 1);
    const Submap b = submapOf(corridor, along, 3, 10, 2);
    const LoopClosure loop = judgeLoop(a, b, candidate({Matrix3d::Identity(), {3, 0, 0}}));
    EXPECT_EQ(loop.verdict, Verdict::Pending) << loop.reason;
    EXPECT_LT(loop.evidence.directions, 6);
    EXPECT_LT(loop.information(0, 0), 1e-3 * loop.information(1, 1));
}

TEST(ALoop, UpsideDownIsRefused)
{
    const Submap a = submapOf(hall(1), alongHall, 0, 9, 1);
    Submap b = submapOf(hall(1), alongHall, 0.5, 9, 2);
    b.up_submap = -Vector3d::UnitZ();
    const LoopClosure loop = judgeLoop(a, b, candidate({Matrix3d::Identity(), {0.5, 0, 0}}));
    EXPECT_EQ(loop.verdict, Verdict::Refused);
    EXPECT_NE(loop.reason.find("gravity"), std::string::npos) << loop.reason;
}
