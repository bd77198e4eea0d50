#include "taut/submaps/SubmapBuilder.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "walks.h"

using namespace taut;
using namespace taut::test;

namespace
{
class ASubmapBuilder : public ::testing::Test
{
 protected:
    void walk(double length, double step = 0.5)
    {
        DriftingOdometry odometry;
        odometry.start(aroundRing(0));
        Random random(1);
        builder.start(estimateAt(1'700'000'000'000'000'000, odometry.estimate));
        carry(
            ring(), aroundRing, length, odometry, random,
            [&](const NavEstimate& e, const std::vector<Vector3d>& p)
            {
                if (doubtAt && e.state.t >= *doubtAt) builder.setDoubt(true);
                builder.add(e, p, {});
            },
            step);
        builder.finish();
    }

    SubmapConfig config;
    std::optional<Time> doubtAt;
    std::vector<Submap> submaps;
    SubmapBuilder builder{config, [this](Submap s) { submaps.push_back(std::move(s)); }};
};
}  // namespace

TEST_F(ASubmapBuilder, CutsTheWayIntoPiecesThatFollowOnEachOther)
{
    walk(60);
    ASSERT_GE(submaps.size(), 3u);
    for (std::size_t i = 0; i + 1 < submaps.size(); i++)
    {
        const Submap &a = submaps[i], &b = submaps[i + 1];
        EXPECT_EQ(b.id, a.id + 1);
        EXPECT_EQ(a.last().t, b.scans.front().t);
        EXPECT_EQ(a.path_end, b.path_begin);
        EXPECT_NEAR(a.last().T_submap_imu.p.norm(), config.min_length, 0.6);
        const Pose end = a.T_world_submap * a.last().T_submap_imu;
        const Pose begin = b.T_world_submap * b.scans.front().T_submap_imu;
        EXPECT_LT((end.p - begin.p).norm() + (end.R - begin.R).norm(), 1e-12);
        EXPECT_GT(a.points.size(), 1000u);
        EXPECT_GE(a.key_scans.size(), 3u);
    }
}

TEST_F(ASubmapBuilder, KeepsPointsWhereTheyWereSeen)
{
    walk(10);
    const Submap& s = submaps.at(0);
    for (const SubmapPoint& p : s.points)
    {
        const Vector3d w = s.T_world_submap * Vector3d(p.position.cast<double>());
        const Scene scene = ring();
        for (int i = 0; i < 3; i++)
        {
            ASSERT_GT(w[i], scene.room.min[i] - 0.1);
            ASSERT_LT(w[i], scene.room.max[i] + 0.1);
        }
    }
}

TEST_F(ASubmapBuilder, IsLessSureFromScanToScan)
{
    walk(10);
    const Submap& s = submaps.at(0);
    EXPECT_TRUE(s.scans.front().covariance.isZero());
    for (std::size_t i = 1; i < s.scans.size(); i++)
    {
        const Matrix6d growth = s.scans[i].covariance - s.scans[i - 1].covariance;
        EXPECT_GE(
            Eigen::SelfAdjointEigenSolver<Matrix6d>(growth).eigenvalues().minCoeff(),
            -1e-12 * growth.norm());
        EXPECT_GT(growth.trace(), 0);
    }
    // Its position, by the share of the way that the configuration says.
    const SubmapScan& last = s.last();
    const Vector3d at = last.T_submap_imu.p;
    Matrix6d to_position = Matrix6d::Identity();
    to_position.topRightCorner<3, 3>() = -hat(at);
    const Matrix6d there = to_position * last.covariance * to_position.transpose();
    EXPECT_NEAR(std::sqrt(there(2, 2)), config.drift_position * (s.path_end - s.path_begin), 2e-3);
}

TEST_F(ASubmapBuilder, EndsASubmapWhereDoubtBegins)
{
    doubtAt = 1'700'000'000'000'000'000 + 5'000'000'000;
    walk(10);
    ASSERT_GE(submaps.size(), 2u);
    EXPECT_FALSE(submaps[0].doubtful);
    EXPECT_TRUE(submaps[1].doubtful);
    EXPECT_LT(submaps[0].last().t, *doubtAt);
    EXPECT_GT(submaps[1].last().covariance(0, 0), 100 * submaps[0].last().covariance(0, 0));
}

TEST_F(ASubmapBuilder, GivesNothingWithoutAScan)
{
    builder.start(estimateAt(1, {}));
    builder.finish();
    EXPECT_TRUE(submaps.empty());
}
