#include "taut/slam/PathCorrection.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

namespace
{
Pose anyPose(Random& random, double position, double angle)
{
    return {expSO3(random.vector(angle)), random.vector(position)};
}

/** A walk of n steps; `variance` of each. */
Submap walk(Random& random, const std::vector<double>& variance)
{
    Submap submap;
    submap.scans.push_back({0, {}, Matrix6d::Zero()});
    for (const double v : variance)
    {
        SubmapScan scan = submap.scans.back();
        scan.t += 1;
        scan.T_submap_imu = scan.T_submap_imu * anyPose(random, 0.5, 0.1);
        scan.covariance += v * Matrix6d::Identity();
        submap.scans.push_back(scan);
    }
    return submap;
}

double difference(const Pose& a, const Pose& b)
{
    return (a.p - b.p).norm() + (a.R - b.R).norm();
}
}  // namespace

TEST(ErrorsOfPoses, GoFromTheLeftToTheRight)
{
    Random random(1);
    for (int i = 0; i < 50; i++)
    {
        const Pose T = anyPose(random, 5, 1);
        const auto right = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
        {
            const Pose moved = Pose{expSO3(d.tail<3>()), d.head<3>()} * T;
            return rightErrorTo(T, moved);
        };
        EXPECT_LT((numericJacobian(right, 6) - rightFromLeft(T)).cwiseAbs().maxCoeff(), 1e-8);
    }
}

TEST(ACorrectedPath, WithoutAGapIsTheOdometrys)
{
    Random random(2);
    const Submap submap = walk(random, {1e-4, 2e-4, 1e-4});
    const Pose T = anyPose(random, 10, 1), next = anyPose(random, 3, 0.5);
    const std::vector<Pose> poses = correctedPoses(submap, T, next, T * next);
    for (std::size_t i = 0; i < poses.size(); i++)
        EXPECT_LT(difference(poses[i], T * submap.scans[i].T_submap_imu), 1e-12);
}

TEST(ACorrectedPath, EndsWhereTheNextSubmapBegins)
{
    Random random(3);
    const Submap submap = walk(random, {1e-4, 2e-4, 1e-4, 5e-5});
    const Pose T = anyPose(random, 10, 1), next = anyPose(random, 3, 0.5);
    const Pose T_next = T * next * anyPose(random, 0.3, 0.1);
    const std::vector<Pose> poses = correctedPoses(submap, T, next, T_next);
    EXPECT_LT(difference(poses.front(), T * submap.scans.front().T_submap_imu), 1e-12);
    const Pose last_in_next = next.inverse() * submap.last().T_submap_imu;
    EXPECT_LT(difference(poses.back(), T_next * last_in_next), 1e-9);
}

TEST(ACorrectedPath, TakesTheGapWhereTheOdometryWasUnsure)
{
    Random random(4);
    const Submap submap = walk(random, {1e-8, 1e-8, 1e-2, 1e-8});
    const Pose next = submap.last().T_submap_imu;
    Pose gap;
    gap.p = {0.2, -0.1, 0.05};
    const std::vector<Pose> poses = correctedPoses(submap, {}, next, gap * next);
    EXPECT_LT((poses[2].p - submap.scans[2].T_submap_imu.p).norm(), 1e-5);
    EXPECT_LT((poses[3].p - submap.scans[3].T_submap_imu.p - gap.p).norm(), 1e-5);
}

TEST(ACorrectedPath, IsWhatTheWholeChainOfStepsWouldBecome)
{
    // The dense smoother: all poses are unknown, steps are measured, both ends are held.
    Random random(6);
    const Submap submap = walk(random, {1e-4, 3e-4, 2e-4, 5e-5, 1e-4});
    const std::size_t n = submap.scans.size();
    Vector6d gap;
    gap << 0.02, -0.01, 0.015, 0.001, -0.002, 0.0015;
    // On the left, errors add up along the chain: d_m = sum of e_j, e_j ~ N(0, Q_j), d_last = gap.
    Eigen::VectorXd e = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * (n - 1)));
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t j = 1; j < n; j++)
        sum += submap.scans[j].covariance - submap.scans[j - 1].covariance;
    for (std::size_t j = 1; j < n; j++)
        e.segment<6>(static_cast<Eigen::Index>(6 * (j - 1))) =
            (submap.scans[j].covariance - submap.scans[j - 1].covariance) * sum.inverse() * gap;
    const Pose next = submap.last().T_submap_imu;
    const Pose moved = Pose{expSO3(gap.tail<3>()), gap.head<3>()} * next;
    const std::vector<Pose> poses = correctedPoses(submap, {}, next, moved);
    Vector6d d = Vector6d::Zero();
    for (std::size_t m = 1; m < n; m++)
    {
        d += e.segment<6>(static_cast<Eigen::Index>(6 * (m - 1)));
        const Pose expected = Pose{expSO3(d.tail<3>()), d.head<3>()} * submap.scans[m].T_submap_imu;
        EXPECT_LT(difference(poses[m], expected), 1e-9) << m;
    }
}
