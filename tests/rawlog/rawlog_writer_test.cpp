#include "mrpt_support.h"

namespace taut::test
{
namespace fs = std::filesystem;
using RawlogWriterTest = RawlogTest;

TEST_F(RawlogWriterTest, LeavesNothingBehindWhereItIsNotClosed)
{
    {
        RawlogWriter writer(path("a.rawlog"));
        writeLog(writer, 5);
        EXPECT_FALSE(fs::exists(path("a.rawlog")));
    }
    EXPECT_TRUE(fs::is_empty(path(".")));
}

TEST_F(RawlogWriterTest, ReplacesAnOlderLogOnlyWhenItIsComplete)
{
    writeFile(path("a.rawlog"), Bytes(10));
    RawlogWriter writer(path("a.rawlog"));
    writeLog(writer, 5);
    EXPECT_EQ(fs::file_size(path("a.rawlog")), 10u);
    writer.close();
    EXPECT_EQ(readAll(path("a.rawlog")).scans.size(), 5u);
    EXPECT_THROW(writeLog(writer, 1), std::logic_error);
}

TEST_F(RawlogWriterTest, NamesAFileThatCannotBeWritten)
{
    try
    {
        RawlogWriter writer(path("none/a.rawlog"));
        FAIL();
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_NE(std::string(e.what()).find("none/a.rawlog"), std::string::npos);
    }
}

TEST_F(RawlogWriterTest, KeepsTimesTo100NanosecondsAndClampsIntensities)
{
    Scan scan = smallScan(kStart + 123'456'700);
    scan.points[1].offset = 1'234'567;
    scan.points[1].intensity = 300;
    scan.points[2].intensity = -1;
    scan.points[3].intensity = 17.6f;
    RawlogWriter writer(path("a.rawlog"));
    writer.write(scan);
    writer.close();
    const auto read = readAll(path("a.rawlog")).scans.at(0);
    EXPECT_EQ(read.stamp, kStart + 123'456'700);
    EXPECT_EQ(read.points[1].offset, 1'234'600);
    EXPECT_EQ(read.points[1].intensity, 255);
    EXPECT_EQ(read.points[2].intensity, 0);
    EXPECT_EQ(read.points[3].intensity, 18);
}

TEST_F(RawlogWriterTest, WritesThePosesOfBothSensorsOnTheVehicle)
{
    RawlogWriterConfig config;
    config.T_vehicle_imu = {expSO3({0.3, 0.2, -0.1}), {1, 2, 3}};
    config.imu_label = "imu0";
    config.lidar_label = "lidar0";
    const Pose T_imu_lidar{expSO3({-0.5, 0.1, 0.7}), {0.1, -0.2, 0.3}};
    RawlogWriter writer(path("a.rawlog"), config);
    writeLog(writer, 2, T_imu_lidar);
    writer.close();
    const auto log = readAll(path("a.rawlog"));
    EXPECT_LT((log.scans.at(0).T_imu_lidar.R - T_imu_lidar.R).norm(), 1e-12);
    EXPECT_LT((log.scans[0].T_imu_lidar.p - T_imu_lidar.p).norm(), 1e-12);
    EXPECT_EQ(log.progress.imu_label, "imu0");
    EXPECT_EQ(log.scans[0].sensor_label, "lidar0");
}
}  // namespace taut::test
