#include "taut/odometry/PoseSearch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "recording.h"
#include "taut/map/OctreeMap.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** How far two poses are apart for a search: in metres, and radians of which 0.2 weigh as much. */
double apart(const Pose& a, const Pose& b)
{
    return std::max((a.p - b.p).norm(), 5 * logSO3(a.R.transpose() * b.R).norm());
}

double nearest(const std::vector<Pose>& poses, const Pose& pose)
{
    double least = 1e9;
    for (const Pose& p : poses) least = std::min(least, apart(p, pose));
    return least;
}

/** The points of a scan in the body frame, as a body at rest sees them. */
std::vector<MapPoint> inBody(const Scan& scan)
{
    std::vector<MapPoint> points;
    for (const LidarPoint& p : scan.points)
    {
        const Vector3d x = scan.T_imu_lidar * Vector3d(p.position.cast<double>());
        points.push_back({x, FeatureKind::Any, -x.normalized()});
    }
    return points;
}

class PoseSearchTest : public testing::Test
{
 protected:
    PoseSearchTest()
    {
        Recording still;
        still.columns = 500;
        const Pose T = still.pose(0);
        const Scan scan = still.scan(still.start);
        seen = inBody(scan);
        std::vector<MapPoint> world = seen;
        for (MapPoint& p : world)
        {
            p.position = T * p.position;
            p.view = T.R * p.view;
        }
        for (int i = 0; i < 3; i++) map.insert(world, executor);
        truth = T;
    }

    OctreeMap map;
    Executor executor;
    std::vector<MapPoint> seen;
    Pose truth;
};
}  // namespace

TEST(PosesAfterAGap, CoverWhatAPersonOrAVehicleCanHaveDone)
{
    NavState before;
    before.T_world_imu = {expSO3({0, 0, 2}) * expSO3({0.1, -0.05, 0}), {3, -2, 1}};
    Random random(5);
    for (const Vector3d& v : {Vector3d(0, 0, 0), Vector3d(1.5, 0.3, 0), Vector3d(-8, 6, 0.5)})
        for (const double gap : {0.5, 1.0, 2.0})
        {
            before.v_world = v;
            const Vector3d up = before.T_world_imu.R.transpose() * kGravityWorld;
            const std::vector<Pose> poses = PoseSearch::posesAfter(gap, before, up);
            EXPECT_LT(nearest(poses, before.T_world_imu), 0.6) << "it may not have moved";
            for (int i = 0; i < 20; i++)
            {
                const Vector3d a = random.vector(0.6);
                const Vector3d level(a.x(), a.y(), 0);
                const double yaw = std::clamp(random.normal(), -1.5, 1.5) * 0.6 * gap;
                Pose there = before.T_world_imu;
                there.p += v * gap + 0.5 * level * gap * gap;
                there.R = expSO3({0, 0, std::clamp(yaw, -1.1, 1.1)}) * there.R;
                EXPECT_LT(nearest(poses, there), 0.6);
            }
        }
}

TEST(PosesAfterAGap, AreNotWithoutNumberAfterALongGap)
{
    NavState before;
    before.v_world = {20, 10, 3};
    for (const double gap : {10.0, 3600.0, 1e9})
        EXPECT_LT(PoseSearch::posesAfter(gap, before, kGravityWorld).size(), 50'000u);
}

TEST(PosesAfterAGap, AreLevelledByTheSpecificForceToo)
{
    NavState before;
    const Matrix3d tilted = expSO3({0.5, 0, 0});
    const std::vector<Pose> poses =
        PoseSearch::posesAfter(1, before, tilted.transpose() * kGravityWorld);
    EXPECT_LT(nearest(poses, {tilted, {0, 0, 0}}), 0.6);
    for (const Pose& p : PoseSearch::posesAfter(1, before, {0.1, 0, 0}))
        EXPECT_NEAR(p.R(2, 2), 1, 1e-9) << "free fall tells no tilt";
}

TEST_F(PoseSearchTest, FindsWhereAScanWasSeen)
{
    NavState before;
    before.T_world_imu = {expSO3({0, 0, 0.5}) * truth.R, truth.p + Vector3d(-1.2, 0.5, 0.1)};
    before.v_world = {0.8, 0, 0};
    PoseSearch search(seen, map, executor);
    const Vector3d up = truth.R.transpose() * kGravityWorld;
    const std::vector<Pose> best = search.bestOf(PoseSearch::posesAfter(1, before, up), 5);
    ASSERT_EQ(best.size(), 5u);
    EXPECT_LT(nearest(best, truth), 0.8);
    for (std::size_t i = 1; i < best.size(); i++)
        EXPECT_GE(search.inlierWeight(best[i - 1]), search.inlierWeight(best[i]));
    const Pose turned{expSO3({0, 0, 0.4}) * truth.R, truth.p};
    EXPECT_GT(search.inlierWeight(truth), 1.3 * search.inlierWeight(turned));
}

TEST_F(PoseSearchTest, NothingIsExplainedWhereThereIsNoMap)
{
    PoseSearch search(seen, map, executor);
    EXPECT_EQ(search.inlierWeight({truth.R, truth.p + Vector3d(500, 0, 0)}), 0);
    EXPECT_EQ(PoseSearch({}, map, executor).inlierWeight(truth), 0);
}
