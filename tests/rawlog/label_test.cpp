#include <gmock/gmock.h>

#include "mrpt_support.h"

namespace taut::test
{
using testing::AllOf;
using testing::HasSubstr;

class SensorLabels : public RawlogTest
{
 protected:
    /** Two LiDARs, two IMUs. */
    SensorLabels()
    {
        LogBytes log;
        for (int k = 0; k < 20; k++)
        {
            const Time t = kStart + k * 100 * kMillisecond;
            log.add(mrptImu(t, "IMU_A")).add(mrptImu(t, "IMU_B"));
            log.add(mrptScan(t, "FRONT")).add(mrptScan(t, "REAR"));
        }
        config_.path = path("two.rawlog");
        writeFile(config_.path, log.bytes());
    }

    std::string error() const
    {
        try
        {
            readAll(config_);
        }
        catch (const std::runtime_error& e)
        {
            return e.what();
        }
        return "";
    }

    RawlogConfig config_;
};

TEST_F(SensorLabels, TwoOfAKindWithoutAChoiceIsAnErrorThatNamesThemAndTheOption)
{
    config_.imu_label = "IMU_A";
    EXPECT_THAT(error(), AllOf(HasSubstr("'FRONT'"), HasSubstr("'REAR'"), HasSubstr("--lidar")));
    config_ = {};
    config_.path = path("two.rawlog");
    config_.lidar_label = "REAR";
    EXPECT_THAT(error(), AllOf(HasSubstr("'IMU_A'"), HasSubstr("'IMU_B'"), HasSubstr("--imu")));
}

TEST_F(SensorLabels, AnExpressionChoosesByTheWholeLabel)
{
    config_.lidar_label = "RE.R";
    config_.imu_label = ".*B";
    const auto log = readAll(config_);
    EXPECT_EQ(log.scans.size(), 20u);
    EXPECT_EQ(log.scans[0].sensor_label, "REAR");
    EXPECT_EQ(log.imu.size(), 20u);
    EXPECT_EQ(log.progress.lidar_label, "REAR");
    EXPECT_EQ(log.progress.imu_label, "IMU_B");
    const std::pair<std::string, std::string> other{"FRONT", "CObservationVelodyneScan"};
    EXPECT_EQ(log.progress.sensors.at(other), 20u);
    EXPECT_TRUE(log.warnings.kept().empty());
}

TEST_F(SensorLabels, AnExpressionThatMatchesTwoIsAnError)
{
    config_.lidar_label = "FRONT|REAR";
    config_.imu_label = "IMU_A";
    EXPECT_THAT(error(), AllOf(HasSubstr("'FRONT'"), HasSubstr("'REAR'"), HasSubstr("matches")));
}

TEST_F(SensorLabels, AnExpressionThatMatchesNoLidarIsAnErrorThatNamesWhatIsThere)
{
    config_.lidar_label = "TOP";
    config_.imu_label = "IMU_A";
    EXPECT_THAT(
        error(),
        AllOf(HasSubstr("two.rawlog"), HasSubstr("FRONT"), HasSubstr("CObservationVelodyneScan")));
}

TEST_F(SensorLabels, AnExpressionThatMatchesNoImuIsAWarning)
{
    config_.lidar_label = "FRONT";
    config_.imu_label = "IMU_C";
    const auto log = readAll(config_);
    EXPECT_EQ(log.scans.size(), 20u);
    EXPECT_FALSE(log.progress.has_imu);
    ASSERT_EQ(log.warnings.count("imu_not_found"), 1u);
    EXPECT_THAT(log.warnings.kept()[0].text, HasSubstr("IMU_A"));
}

TEST_F(SensorLabels, SomethingThatIsNoExpressionIsAnErrorThatQuotesIt)
{
    config_.lidar_label = "(";
    EXPECT_THAT(error(), HasSubstr("'('"));
}

TEST_F(SensorLabels, TheLabelOfTheRigChoosesWhereNoneIsGiven)
{
    config_.rig.lidar.label = "FRONT";
    config_.rig.imu.label = "IMU_B";
    EXPECT_EQ(readAll(config_).scans[0].sensor_label, "FRONT");
}

TEST_F(SensorLabels, ARigThatDescribesAnotherSensorIsNotAppliedToTheOneInUse)
{
    config_.imu_label = "IMU_A";
    config_.lidar_label = "REAR";
    config_.rig.lidar.label = "FRONT";
    config_.rig.lidar.T_vehicle_lidar = Pose{Matrix3d::Identity(), {1, 2, 3}};
    const auto log = readAll(config_);
    EXPECT_EQ(log.scans[0].T_imu_lidar.p, Vector3d::Zero());
    EXPECT_EQ(log.warnings.count("rig_unused"), 1u);
}

TEST_F(RawlogTest, ASecondLidarThatAppearsLateIsAnErrorAsWell)
{
    LogBytes log;
    for (int k = 0; k < 60; k++) log.add(mrptScan(kStart + k * 100 * kMillisecond));
    log.add(mrptScan(kStart + 6000 * kMillisecond, "OTHER"));
    writeFile(path("a.rawlog"), log.bytes());
    RawlogConfig config;
    config.path = path("a.rawlog");
    RawlogSource source(config);
    EXPECT_TRUE(source.next());
    EXPECT_THROW(while (source.next()){}, std::runtime_error);
}

TEST_F(RawlogTest, AnImuAndALidarMayShareALabel)
{
    LogBytes log;
    for (int k = 0; k < 5; k++)
    {
        const Time t = kStart + k * 100 * kMillisecond;
        log.add(mrptImu(t, "")).add(mrptScan(t, ""));
    }
    writeFile(path("a.rawlog"), log.bytes());
    const auto content = readAll(path("a.rawlog"));
    EXPECT_EQ(content.imu.size(), 5u);
    EXPECT_EQ(content.scans.size(), 5u);
    EXPECT_EQ(content.progress.sensors.size(), 2u);
}
}  // namespace taut::test
