#include "taut/rawlog/Rig.h"

#include <gmock/gmock.h>
#include <mrpt/poses/CPose3D.h>

#include "taut/core/Config.h"

namespace taut::test
{
using testing::AllOf;
using testing::HasSubstr;

namespace
{
std::string errorOf(const std::string& text)
{
    try
    {
        parseRig(text, "my.yaml");
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "";
}
}  // namespace

TEST(Rig, TheExampleIsReadWhole)
{
    const Rig rig = loadRig(TAUT_CONFIG_DIR "/rig-example.yaml");
    EXPECT_EQ(rig.lidar.label, "LIDAR.*");
    ASSERT_TRUE(rig.lidar.T_vehicle_lidar);
    EXPECT_EQ(rig.lidar.T_vehicle_lidar->p, Vector3d(0.10, 0, 0.25));
    ASSERT_TRUE(rig.lidar.row_elevations);
    EXPECT_NEAR(rig.lidar.row_elevations->first, 15 * M_PI / 180, 1e-12);
    ASSERT_TRUE(rig.imu.T_vehicle_imu);
    EXPECT_EQ(rig.imu.T_vehicle_imu->p.z(), 0.05);
    ASSERT_TRUE(rig.imu.noise);
    EXPECT_EQ(rig.imu.noise->accel, 2e-3);
}

TEST(Rig, WhatIsNotGivenIsNotOverridden)
{
    const Rig rig = parseRig("imu: {gyro_scale: 0.5}\n");
    EXPECT_FALSE(rig.lidar.T_vehicle_lidar);
    EXPECT_FALSE(rig.lidar.row_elevations);
    EXPECT_FALSE(rig.imu.T_vehicle_imu);
    EXPECT_FALSE(rig.imu.noise);
    EXPECT_EQ(rig.imu.gyro_scale, 0.5);
    EXPECT_EQ(rig.imu.accel_scale, 1);
}

TEST(Rig, AnglesAreThoseOfMrptInDegrees)
{
    const Rig rig = parseRig(
        "lidar:\n  pose: {x: 1, y: 2, z: 3, yaw: 30, pitch: -20, roll: 10}\n"
        "  clock_offset: -0.005\n");
    const double d = M_PI / 180;
    const mrpt::poses::CPose3D expected(1, 2, 3, 30 * d, -20 * d, 10 * d);
    const Pose& pose = rig.lidar.T_vehicle_lidar.value();
    EXPECT_LT((pose.R - expected.getRotationMatrix().asEigen()).norm(), 1e-12);
    EXPECT_EQ(pose.p, Vector3d(1, 2, 3));
    EXPECT_EQ(rig.lidar.clock_offset, -0.005);
}

TEST(Rig, FaultsNameTheFileAndTheKey)
{
    EXPECT_THAT(errorOf("camera: {}\n"), AllOf(HasSubstr("my.yaml"), HasSubstr("camera")));
    EXPECT_THAT(errorOf("imu: {pose: {X: 1}}\n"), HasSubstr("imu.pose.X"));
    EXPECT_THAT(errorOf("imu: {accel_scale: -1}\n"), HasSubstr("imu.accel_scale"));
    EXPECT_THAT(errorOf("imu: {accel_scale: much}\n"), HasSubstr("imu.accel_scale"));
    EXPECT_THAT(errorOf("imu: {noise: {gyro: 0}}\n"), HasSubstr("imu.noise.gyro"));
    EXPECT_THAT(errorOf("lidar: {label: '('}\n"), HasSubstr("'('"));
    EXPECT_THAT(errorOf("lidar: [1, 2\n"), HasSubstr("my.yaml"));
    EXPECT_THAT(errorOf("lidar: 3\n"), HasSubstr("lidar"));
    EXPECT_THROW(loadRig("/no/such/rig.yaml"), ConfigError);
}

TEST(Rig, AnEmptyFileOverridesNothing)
{
    EXPECT_FALSE(parseRig("").lidar.T_vehicle_lidar);
    EXPECT_FALSE(parseRig("# nothing yet\n").imu.noise);
}
}  // namespace taut::test
