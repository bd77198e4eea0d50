#include <gtest/gtest.h>

#include <cmath>

#include "turning.h"

namespace
{
using namespace taut;
using namespace taut::test;

std::optional<RotationAlignment> align(
    const Turning& motion, const Matrix3d& R_expected, const AlignmentConfig& config = {})
{
    return alignRotations(motion.lidar(), GyroRotation(motion.gyro()), R_expected, config);
}

double angleBetween(const Matrix3d& a, const Matrix3d& b)
{
    return logSO3(a.transpose() * b).norm();
}

TEST(TheAlignment, FindsOffsetRotationAndBiasOfPerfectDataExactly)
{
    for (const double offset : {0.0, 0.004, -0.0371, 0.31, -0.44})
    {
        Turning motion;
        motion.clock_offset = offset;
        motion.bias = {0.004, -0.003, 0.002};
        const auto a = align(motion, motion.R_imu_lidar);
        ASSERT_TRUE(a) << offset;
        EXPECT_NEAR(a->clock_offset, offset, 3e-5);
        EXPECT_LT(angleBetween(a->R_imu_lidar, motion.R_imu_lidar), 5e-4);
        EXPECT_LT((a->bias - motion.bias).norm(), 5e-4);
        EXPECT_LT(a->unexplained, 0.01);
        EXPECT_GT(a->turns, 150U);
    }
}

TEST(TheAlignment, FindsARotationFarFromTheExpectedOne)
{
    Turning motion;
    motion.clock_offset = 0.02;
    const auto a = align(motion, motion.R_imu_lidar * expSO3({0.3, -2.0, 1.2}));
    ASSERT_TRUE(a);
    EXPECT_NEAR(a->clock_offset, 0.02, 1e-4);
    EXPECT_LT(angleBetween(a->R_imu_lidar, motion.R_imu_lidar), 2e-3);
}

TEST(TheAlignment, KnowsHowWrongItIs)
{
    double clock = 0, rotation = 0;
    constexpr int kRuns = 12;
    for (unsigned seed = 1; seed <= kRuns; seed++)
    {
        Turning motion;
        motion.clock_offset = 0.0123;
        motion.gyro_noise = 0.02;
        motion.lidar_noise = 3e-3;
        motion.seed = seed;
        const auto a = align(motion, motion.R_imu_lidar);
        ASSERT_TRUE(a);
        EXPECT_LT(a->clock_sigma, 2e-3);
        clock += std::pow((a->clock_offset - 0.0123) / a->clock_sigma, 2) / kRuns;
        const Vector3d e = logSO3(a->R_imu_lidar.transpose() * motion.R_imu_lidar);
        rotation += e.dot(a->R_covariance.inverse() * e) / 3 / kRuns;
    }
    // Squares of errors in sigmas: 1 on average if the sigmas are right. The noise of a pose is in
    // two turns with opposite signs, which cancels in the sum: the sigmas err to the safe side.
    EXPECT_GT(clock, 0.1);
    EXPECT_LT(clock, 2);
    EXPECT_GT(rotation, 0.02);
    EXPECT_LT(rotation, 2);
}

TEST(TheAlignment, SaysThatATurnAboutOneAxisLeavesTheRotationAboutItOpen)
{
    Turning motion;
    motion.swing = {0, 0, 1.2};
    motion.R_imu_lidar.setIdentity();
    motion.gyro_noise = 0.01;
    motion.lidar_noise = 1e-3;
    motion.clock_offset = -0.02;
    const auto a = align(motion, Matrix3d::Identity());
    ASSERT_TRUE(a);
    EXPECT_NEAR(a->clock_offset, -0.02, 2e-3);
    EXPECT_GT(std::sqrt(a->R_covariance(2, 2)), 0.05);
    EXPECT_LT(std::sqrt(a->R_covariance(0, 0)), 0.01);
    EXPECT_LT(std::sqrt(a->R_covariance(1, 1)), 0.01);
}

TEST(TheAlignment, IsNotMovedByAFewWrongTurns)
{
    Turning motion;
    motion.clock_offset = 0.03;
    motion.gyro_noise = 0.01;
    motion.lidar_noise = 1e-3;
    LidarTurns turns = motion.lidar();
    Random random(5);
    for (std::size_t k = 7; k < turns.size(); k += 15) turns[k].turn += random.vector(0.5);
    const auto a = alignRotations(turns, GyroRotation(motion.gyro()), motion.R_imu_lidar);
    ASSERT_TRUE(a);
    EXPECT_NEAR(a->clock_offset, 0.03, 1e-3);
    EXPECT_LT(angleBetween(a->R_imu_lidar, motion.R_imu_lidar), 0.01);
}

TEST(TheAlignment, OfMotionsThatHaveNothingInCommonLeavesThemUnexplained)
{
    Turning other;
    other.swing = {0.9, -0.8, 0.2};
    LidarTurns turns = other.lidar();
    for (std::size_t k = 0; k < turns.size(); k++) turns[k].turn *= k % 2 ? 1 : -1;
    const auto a = alignRotations(turns, GyroRotation(Turning().gyro()), Matrix3d::Identity());
    ASSERT_TRUE(a);
    EXPECT_GT(a->unexplained, 0.6);
}

TEST(TheAlignment, NeedsEnoughTurnsWithinTheSamplesOfTheGyro)
{
    Turning motion;
    LidarTurns few = motion.lidar();
    few.resize(20);  // the first ones lie within the margin of the search
    const GyroRotation gyro(motion.gyro());
    EXPECT_FALSE(alignRotations(few, gyro, motion.R_imu_lidar));
    EXPECT_FALSE(alignRotations({}, gyro, motion.R_imu_lidar));
    EXPECT_FALSE(alignRotations(motion.lidar(), GyroRotation({}), motion.R_imu_lidar));
}
}  // namespace
