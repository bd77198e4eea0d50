#include <gmock/gmock.h>

#include "mrpt_support.h"

namespace taut::test
{
using testing::HasSubstr;

class TimeAndValue : public RawlogTest
{
 protected:
    Content read() const
    {
        writeFile(path("a.rawlog"), log_.bytes());
        RawlogConfig config = config_;
        config.path = path("a.rawlog");
        return readAll(config);
    }

    /** Two seconds of an IMU at 100 Hz with these values, then a scan. */
    Content readConstant(const ImuSample& values)
    {
        log_ = {};
        for (int i = 0; i < 200; i++) log_.add(mrptImu(at(10 * i), "IMU", values));
        log_.add(mrptScan(at(2000)));
        return read();
    }

    static Time at(int milliseconds) { return kStart + milliseconds * kMillisecond; }

    LogBytes log_;
    RawlogConfig config_;
};

TEST_F(TimeAndValue, ImuSamplesThatDoNotMoveForwardInTimeAreSkippedOrSorted)
{
    for (const int t : {0, 10, 20, 20, 15, 30, -2000, 40}) log_.add(mrptImu(at(t)));
    log_.add(mrptScan(at(0)));
    const auto content = read();
    std::vector<Time> times;
    for (const auto& sample : content.imu) times.push_back(sample.t);
    EXPECT_EQ(times, (std::vector<Time>{at(0), at(10), at(15), at(20), at(30), at(40)}));
    ASSERT_EQ(content.warnings.kept().size(), 3u);
    EXPECT_EQ(content.warnings.kept()[0].kind, "imu_order");
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("0.005000 s late"));
    EXPECT_EQ(content.warnings.kept()[1].kind, "imu_duplicate");
    EXPECT_THAT(content.warnings.kept()[1].text, HasSubstr("same stamp"));
    EXPECT_EQ(content.warnings.kept()[2].kind, "imu_time");
    EXPECT_THAT(content.warnings.kept()[2].text, HasSubstr("backward by 2.030000 s"));
    EXPECT_EQ(content.progress.skipped, 2u);
}

TEST_F(TimeAndValue, OneStampInTheFutureIsSkippedAlone)
{
    for (int k = 0; k < 30; k++)
    {
        for (int i = 0; i < 10; i++)
            log_.add(mrptImu(at(100 * k + 10 * i + (k == 0 && i == 0 ? 3'600'000 : 0))));
        log_.add(mrptScan(at(100 * k + (k == 14 ? 3'600'000 : 0))));
    }
    const auto content = read();
    EXPECT_EQ(content.imu.size(), 299u);
    EXPECT_EQ(content.scans.size(), 29u);
    EXPECT_EQ(content.warnings.count("stamp_outlier"), 2u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("of an IMU sample is 3599.990000 s"));
    EXPECT_EQ(content.progress.first, at(10));
    EXPECT_EQ(content.progress.now, at(2990));
    EXPECT_EQ(content.progress.skipped, 2u);
}

TEST_F(TimeAndValue, ScansThatDoNotMoveForwardInTimeAreSkipped)
{
    for (const int t : {0, 100, 100, 50, 200}) log_.add(mrptScan(at(t)));
    auto short_scan = mrptScan(at(250));  // begins later, ends earlier
    for (std::size_t i = 0; i < 100; i++)
        short_scan.point_cloud.timestamp[i] = mrptTime(at(200) + static_cast<Time>(i));
    log_.add(short_scan).add(mrptScan(at(300)));
    const auto content = read();
    std::vector<Time> times;
    for (const auto& scan : content.scans) times.push_back(scan.stamp);
    EXPECT_EQ(times, (std::vector<Time>{at(0), at(100), at(200), at(300)}));
    EXPECT_EQ(content.warnings.count("scan_duplicate"), 1u);
    EXPECT_EQ(content.warnings.count("scan_time"), 2u);
}

TEST_F(TimeAndValue, ScansThatOverlapAreUsedAndWarnedOf)
{
    log_.add(mrptScan(at(0))).add(mrptScan(at(90))).add(mrptScan(at(110)));
    const auto content = read();
    EXPECT_EQ(content.scans.size(), 3u);
    ASSERT_EQ(content.warnings.count("scan_overlap"), 1u);
    EXPECT_EQ(content.warnings.kept()[0].t, at(110));
}

TEST_F(TimeAndValue, ObservationsWithoutAStampAreSkipped)
{
    auto imu = mrptImu(at(0));
    imu.timestamp = INVALID_TIMESTAMP;
    auto scan = mrptScan(at(0));
    scan.timestamp = INVALID_TIMESTAMP;
    log_.add(imu).add(scan).add(mrptImu(at(10))).add(mrptScan(at(10)));
    const auto content = read();
    EXPECT_EQ(content.imu.size(), 1u);
    EXPECT_EQ(content.scans.size(), 1u);
    EXPECT_EQ(content.warnings.count("no_stamp"), 2u);
    EXPECT_EQ(content.progress.first, at(10));
}

TEST_F(TimeAndValue, ImuSamplesThatAreNotFiniteOrLackAValueAreSkipped)
{
    ImuSample bad = restingImu(0);
    bad.gyro.y() = kNan;
    auto lacking = mrptImu(at(20));
    lacking.dataIsPresent[mrpt::obs::IMU_Z_ACC] = false;
    log_.add(mrptImu(at(0))).add(mrptImu(at(10), "IMU", bad)).add(lacking);
    log_.add(mrptImu(at(30))).add(mrptScan(at(0)));
    const auto content = read();
    EXPECT_EQ(content.imu.size(), 2u);
    EXPECT_EQ(content.warnings.count("imu_invalid"), 2u);
}

TEST_F(TimeAndValue, ImuSamplesBeyondAnyRangeAreSkippedAndNamed)
{
    const ImuSample hit{0, Vector3d::Zero(), Vector3d(0, 1e6, 9.81)};
    const ImuSample spun{0, Vector3d(0, 0, -400), Vector3d(0, 0, 9.81)};
    const ImuSample hard{0, Vector3d(0, 0, 30), Vector3d(0, 400, 9.81)};
    log_.add(mrptImu(at(0))).add(mrptImu(at(10), "IMU", hit)).add(mrptImu(at(20), "IMU", spun));
    log_.add(mrptImu(at(30), "IMU", hard)).add(mrptScan(at(0)));
    auto content = read();
    EXPECT_EQ(content.imu.size(), 2u);
    ASSERT_EQ(content.warnings.count("imu_outlier"), 2u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("1e+06 m/s^2"));
    config_.rig.imu.max_accel = 160;
    content = read();
    EXPECT_EQ(content.imu.size(), 1u);
    config_.rig.imu.max_rate = 500;
    EXPECT_EQ(read().imu.size(), 2u);
}

TEST_F(TimeAndValue, AFewPointsWithAWrongTimeDoNotMoveTheEndOfASweep)
{
    for (int k = 0; k < 10; k++)
    {
        auto scan = mrptScan(at(100 * k));
        if (k == 4) scan.point_cloud.timestamp[60] = mrptTime(at(100 * k + 900));
        if (k == 6)  // more than a mistake: as they are
            for (std::size_t i = 95; i < 100; i++)
                scan.point_cloud.timestamp[i] = mrptTime(at(100 * k + 150));
        log_.add(scan);
    }
    const auto content = read();
    ASSERT_EQ(content.scans.size(), 10u);
    EXPECT_EQ(content.scans[4].points.size(), 99u);
    EXPECT_EQ(content.scans[4].end, at(499));
    EXPECT_EQ(content.scans[5].points.size(), 100u);
    EXPECT_EQ(content.scans[6].end, at(750));
    ASSERT_EQ(content.warnings.count("scan_point_times"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("1 points of 100"));
    EXPECT_EQ(content.progress.points_bad_time, 1u);
}

TEST_F(TimeAndValue, AnImuInTheRightUnitsIsNotDoubted)
{
    EXPECT_TRUE(readConstant(restingImu(0)).warnings.kept().empty());
    // A biased gyro in a steady turn around the vertical; a car in a sharp bend.
    EXPECT_TRUE(
        readConstant({0, Vector3d(0.03, 0.02, 2), Vector3d(0.3, 0, 9.81)}).warnings.kept().empty());
    EXPECT_TRUE(readConstant({0, Vector3d(0, 0, 1), Vector3d(0, 6, 9.81)}).warnings.kept().empty());
}

TEST_F(TimeAndValue, SpecificForceInGIsSaidAndCuredByTheRig)
{
    const ImuSample in_g{0, Vector3d::Zero(), Vector3d(0, 0.1, 0.99)};
    auto content = readConstant(in_g);
    ASSERT_EQ(content.warnings.count("imu_units"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("accel_scale: 9.80665"));
    EXPECT_EQ(content.imu[0].accel, in_g.accel);  // never changed silently
    config_.rig.imu.accel_scale = 9.80665;
    content = readConstant(in_g);
    EXPECT_EQ(content.warnings.count("imu_units"), 0u);
    EXPECT_NEAR(content.imu[0].accel.z(), 9.7086, 1e-4);
}

TEST_F(TimeAndValue, RatesInDegreesAreSaidAndCuredByTheRig)
{
    // A bias of 0.5 deg/s at rest reads as half a radian a second that gravity does not follow.
    const ImuSample resting{0, Vector3d(0.5, 0, 0), Vector3d(0, 0, 9.81)};
    auto content = readConstant(resting);
    ASSERT_EQ(content.warnings.count("imu_units"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("gyro_scale: 0.0174532925"));
    config_.rig.imu.gyro_scale = M_PI / 180;
    content = readConstant(resting);
    EXPECT_EQ(content.warnings.count("imu_units"), 0u);
    EXPECT_NEAR(content.imu[0].gyro.x(), 0.5 * M_PI / 180, 1e-12);
    config_ = {};
    content = readConstant({0, Vector3d(0, 0, 150), Vector3d(0, 0, 9.81)});
    EXPECT_EQ(content.warnings.count("imu_units"), 1u);
}

TEST_F(TimeAndValue, TheBodyIsTheImuWhereverItIsMounted)
{
    auto imu = mrptImu(at(10));
    imu.sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6);
    auto scan = mrptScan(at(0));  // before the first IMU sample
    scan.sensorPose = mrpt::poses::CPose3D(-1, 0.5, 2, 1.4, -0.5, 0.2);
    log_.add(scan).add(imu).add(mrptScan(at(100)));
    const auto content = read();
    const auto expected = scan.sensorPose - imu.sensorPose;  // MRPT's inverse composition
    const Pose& T_imu_lidar = content.scans.at(0).T_imu_lidar;
    EXPECT_LT((T_imu_lidar.R - expected.getRotationMatrix().asEigen()).norm(), 1e-12);
    EXPECT_NEAR(T_imu_lidar.p.x(), expected.x(), 1e-12);
    EXPECT_NEAR(T_imu_lidar.p.y(), expected.y(), 1e-12);
    EXPECT_NEAR(T_imu_lidar.p.z(), expected.z(), 1e-12);
}

TEST_F(TimeAndValue, TheRigOverridesPosesAndTheClockOfTheLidar)
{
    auto imu = mrptImu(at(10));
    imu.sensorPose = mrpt::poses::CPose3D(1, 1, 1, 1, 1, 1);
    log_.add(imu).add(mrptScan(at(0)));
    config_.rig.imu.T_vehicle_imu = Pose{Matrix3d::Identity(), {0, 0, 0.5}};
    config_.rig.lidar.T_vehicle_lidar = Pose{expSO3({0, 0, 1}), {0, 0, 2}};
    config_.rig.lidar.clock_offset = -0.004;
    const auto content = read();
    const Scan& scan = content.scans.at(0);
    EXPECT_LT((scan.T_imu_lidar.p - Vector3d(0, 0, 1.5)).norm(), 1e-12);
    EXPECT_LT((scan.T_imu_lidar.R - expSO3({0, 0, 1})).norm(), 1e-12);
    EXPECT_EQ(scan.stamp, at(-4));
    EXPECT_EQ(scan.end, at(95));
    EXPECT_EQ(scan.points[7].offset, 7 * kMillisecond);
    EXPECT_EQ(content.imu.at(0).t, at(10));
}

TEST_F(TimeAndValue, ALogWithoutAnImuSaysSo)
{
    log_.add(mrptScan(at(0)));
    const auto content = read();
    EXPECT_FALSE(content.progress.has_imu);
    EXPECT_EQ(content.progress.imu_samples, 0u);
    EXPECT_TRUE(content.warnings.kept().empty());
}

TEST_F(TimeAndValue, AnImuThatAppearsLateIsWarnedOf)
{
    for (int k = 0; k < 40; k++) log_.add(mrptScan(at(100 * k)));
    log_.add(mrptImu(at(3990)));
    const auto content = read();
    EXPECT_EQ(content.imu.size(), 1u);
    EXPECT_TRUE(content.progress.has_imu);
    EXPECT_EQ(content.warnings.count("imu_late"), 1u);
}

class PartOfALog : public TimeAndValue
{
 protected:
    PartOfALog()
    {
        for (int k = 0; k < 100; k++)
        {
            for (int i = 0; i < 10; i++) log_.add(mrptImu(at(100 * k + 10 * i)));
            log_.add(mrptScan(at(100 * k)));
        }
    }
};

TEST_F(PartOfALog, BeginsAndEndsWhereAsked)
{
    config_.from_time = 3;
    config_.to_time = 5.05;
    const auto content = read();
    EXPECT_EQ(content.scans.front().stamp, at(3000));
    EXPECT_EQ(content.scans.back().stamp, at(5000));
    EXPECT_EQ(content.imu.front().t, at(3000));
    EXPECT_GE(content.imu.back().t, content.scans.back().end);
    EXPECT_LE(content.imu.back().t, at(6200));
    EXPECT_LT(content.progress.now, at(6200));
    EXPECT_FALSE(content.incomplete);
}

TEST_F(PartOfALog, EndsAfterTheFirstScansOnceTheImuCoversThem)
{
    config_.only_first_n = 7;
    const auto content = read();
    ASSERT_EQ(content.scans.size(), 7u);
    EXPECT_GE(content.imu.back().t, content.scans.back().end);
    EXPECT_LE(content.imu.back().t, content.scans.back().end + 20 * kMillisecond);
}

TEST_F(PartOfALog, EndsAfterTheFirstScansWithoutAnImuAsWell)
{
    log_ = {};
    for (int k = 0; k < 100; k++) log_.add(mrptScan(at(100 * k)));
    config_.only_first_n = 7;
    const auto content = read();
    EXPECT_EQ(content.scans.size(), 7u);
    EXPECT_LT(content.progress.now, at(4000));
}

TEST_F(PartOfALog, ProgressRunsOverTheBytesOfTheFileAndTheTimeOfTheLog)
{
    writeFile(path("a.rawlog"), log_.bytes());
    RawlogConfig config;
    config.path = path("a.rawlog");
    RawlogSource source(config);
    double fraction = 0;
    Time now = kStart;
    while (source.next())
    {
        const auto progress = source.progress();
        EXPECT_GE(progress.fraction(), fraction);
        EXPECT_GE(progress.now, now);
        fraction = progress.fraction();
        now = progress.now;
    }
    EXPECT_EQ(source.progress().fraction(), 1);
    EXPECT_EQ(now, at(9990));
    EXPECT_EQ(source.progress().scans, 100u);
    EXPECT_EQ(source.progress().imu_samples, 1000u);
}
}  // namespace taut::test
