#include <mrpt/obs/CObservationComment.h>

#include "mrpt_support.h"

namespace taut::test
{
using RawlogSourceTest = RawlogTest;

TEST_F(RawlogSourceTest, GivesBackWhatTheWriterWroteInTheOrderOfTheFile)
{
    Pose T_imu_lidar{expSO3({0.1, -0.2, 0.3}), {0.5, -0.25, 1}};
    RawlogWriter writer(path("a.rawlog"));
    writeLog(writer, 30, T_imu_lidar);
    writer.close();

    const auto log = readAll(path("a.rawlog"));
    ASSERT_EQ(log.scans.size(), 30u);
    ASSERT_EQ(log.imu.size(), 300u);
    ASSERT_EQ(log.all.size(), 330u);
    for (std::size_t i = 0; i < 330; i++)
        EXPECT_EQ(std::holds_alternative<Scan>(log.all[i]), i % 11 == 10);
    EXPECT_EQ(log.imu[7].t, kStart + 70 * kMillisecond);
    EXPECT_EQ(log.imu[7].accel, Vector3d(0, 0, 9.81));
    EXPECT_EQ(log.imu[7].gyro, Vector3d(0, 0, 0.001));
    const Scan expected = smallScan(kStart + 500 * kMillisecond);
    const Scan& scan = log.scans[5];
    EXPECT_EQ(scan.stamp, expected.stamp);
    EXPECT_EQ(scan.end, expected.end);
    EXPECT_EQ(scan.rings, 4);
    EXPECT_EQ(scan.sensor_label, "LIDAR");
    EXPECT_FALSE(scan.already_undistorted);
    EXPECT_LT((scan.T_imu_lidar.R - T_imu_lidar.R).norm(), 1e-12);
    EXPECT_LT((scan.T_imu_lidar.p - T_imu_lidar.p).norm(), 1e-12);
    ASSERT_EQ(scan.points.size(), expected.points.size());
    for (std::size_t i = 0; i < scan.points.size(); i++)
    {
        EXPECT_EQ(scan.points[i].position, expected.points[i].position);
        EXPECT_EQ(scan.points[i].intensity, expected.points[i].intensity);
        EXPECT_EQ(scan.points[i].offset, expected.points[i].offset);
        EXPECT_EQ(scan.points[i].ring, expected.points[i].ring);
    }
    EXPECT_TRUE(log.progress.has_imu);
    EXPECT_FALSE(log.incomplete);
    EXPECT_TRUE(log.warnings.kept().empty());
}

TEST_F(RawlogSourceTest, ReadsSensoryFramesAndPlainFilesAsWell)
{
    LogBytes observations, frames;
    for (int k = 0; k < 10; k++)
    {
        const Time t = kStart + k * 100 * kMillisecond;
        observations.add(mrptImu(t)).add(mrptScan(t));
        mrpt::obs::CSensoryFrame frame;
        frame.insert(std::make_shared<mrpt::obs::CObservationIMU>(mrptImu(t)));
        frame.insert(std::make_shared<mrpt::obs::CObservationVelodyneScan>(mrptScan(t)));
        frames.add(mrpt::obs::CActionCollection()).add(frame);
    }
    writeFile(path("observations.rawlog"), observations.bytes());
    writeFile(path("frames.rawlog"), frames.bytes());
    for (const char* name : {"observations.rawlog", "frames.rawlog"})
    {
        const auto log = readAll(path(name));
        EXPECT_EQ(log.imu.size(), 10u);
        ASSERT_EQ(log.scans.size(), 10u);
        for (std::size_t i = 0; i < 20; i++)
            EXPECT_EQ(std::holds_alternative<Scan>(log.all[i]), i % 2 == 1);
        EXPECT_EQ(log.scans[9].end, kStart + 999 * kMillisecond);
        EXPECT_FALSE(log.incomplete);
    }
}

TEST_F(RawlogSourceTest, PassesOverWhatItDoesNotUnderstand)
{
    mrpt::obs::CObservationComment comment;
    comment.text = "fine weather";
    LogBytes log;
    log.add(comment).add(mrptScan(kStart)).add(comment).add(mrptScan(kStart + 100 * kMillisecond));
    writeFile(path("a.rawlog"), log.bytes());
    const auto content = readAll(path("a.rawlog"));
    EXPECT_EQ(content.scans.size(), 2u);
    EXPECT_FALSE(content.incomplete);
}
}  // namespace taut::test
