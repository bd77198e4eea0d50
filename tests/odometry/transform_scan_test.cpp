#include "taut/odometry/transformScan.h"

#include <gtest/gtest.h>

#include <limits>

#include "numeric.h"

using namespace taut;

namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

LidarPoint pointAt(float x, std::int32_t offset)
{
    LidarPoint p;
    p.position = {x, 0, 0};
    p.offset = offset;
    return p;
}

Scan scanOf(const std::vector<LidarPoint>& points)
{
    Scan scan;
    scan.stamp = 1'000'000'000;
    scan.end = 1'100'000'000;
    scan.points = points;
    return scan;
}
}  // namespace

TEST(TransformScan, TakesPointsToTheBodyFrame)
{
    Scan scan = scanOf({pointAt(2, 10)});
    scan.T_imu_lidar = {expSO3({0, 0, M_PI / 2}), {1, 2, 3}};
    scan.rings = 7;
    scan.sensor_label = "front";
    scan.already_undistorted = true;
    scan.points[0].intensity = 0.5F;
    scan.points[0].ring = 4;
    const Scan out = transformScan(scan, {}, scan.stamp);
    ASSERT_EQ(out.points.size(), 1u);
    EXPECT_LT((out.points[0].position - Eigen::Vector3f(1, 4, 3)).norm(), 1e-5);
    EXPECT_EQ(out.points[0].offset, 10);
    EXPECT_EQ(out.points[0].ring, 4);
    EXPECT_EQ(out.points[0].intensity, 0.5F);
    EXPECT_EQ(out.stamp, scan.stamp);
    EXPECT_EQ(out.end, scan.end);
    EXPECT_EQ(out.rings, 7);
    EXPECT_EQ(out.sensor_label, "front");
    EXPECT_TRUE(out.already_undistorted);
    EXPECT_EQ(out.T_imu_lidar.R, Matrix3d::Identity());
    EXPECT_EQ(out.T_imu_lidar.p, Vector3d::Zero());
}

TEST(TransformScan, DropsWhatIsOutOfRangeInTheSensorsFrame)
{
    Scan scan = scanOf(
        {pointAt(0.4F, 1), pointAt(0.6F, 2), pointAt(49, 3), pointAt(51, 4), pointAt(0, 5),
         pointAt(kNaN, 6), pointAt(std::numeric_limits<float>::infinity(), 7)});
    scan.T_imu_lidar.p = {100, 0, 0};  // the range is from the sensor, not from the body
    const Scan out = transformScan(scan, {0.5, 50}, scan.stamp);
    ASSERT_EQ(out.points.size(), 2u);
    EXPECT_EQ(out.points[0].offset, 2);
    EXPECT_EQ(out.points[1].offset, 3);
}

TEST(TransformScan, DropsWhatIsNotAfterThePreviousStateOrIsAfterTheEnd)
{
    const Scan scan = scanOf(
        {pointAt(5, -1), pointAt(5, 20), pointAt(5, 21), pointAt(5, 100'000'000),
         pointAt(5, 100'000'001)});
    const Scan out = transformScan(scan, {}, scan.stamp + 20);
    ASSERT_EQ(out.points.size(), 2u);
    EXPECT_EQ(out.points[0].offset, 21);
    EXPECT_EQ(out.points[1].offset, 100'000'000);
    EXPECT_TRUE(transformScan(scan, {}, scan.end).points.empty());
    EXPECT_TRUE(transformScan(scanOf({}), {}, 0).points.empty());
}
