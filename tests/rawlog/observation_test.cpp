#include <gmock/gmock.h>

#include "mrpt_support.h"

namespace taut::test
{
using mrpt::obs::CObservationVelodyneScan;
using testing::HasSubstr;

class FilledCloud : public RawlogTest
{
 protected:
    Content read(const std::vector<CObservationVelodyneScan>& scans) const
    {
        LogBytes log;
        for (std::size_t k = 0; k < scans.size(); k++) log.add(scans[k]);
        writeFile(path("a.rawlog"), log.bytes());
        return readAll(path("a.rawlog"));
    }
};

TEST_F(FilledCloud, PointsThatAreNotFiniteOrAtTheOriginAreDropped)
{
    auto o = mrptScan(kStart);
    o.point_cloud.x[3] = kNan;
    o.point_cloud.z[5] = std::numeric_limits<float>::infinity();
    o.point_cloud.x[7] = o.point_cloud.y[7] = o.point_cloud.z[7] = 0;
    const auto log = read({o});
    ASSERT_EQ(log.scans.size(), 1u);
    EXPECT_EQ(log.scans[0].points.size(), 97u);
    for (const auto& point : log.scans[0].points) EXPECT_TRUE(point.position.allFinite());
    EXPECT_TRUE(log.warnings.kept().empty());  // 2 % is what sensors do
}

TEST_F(FilledCloud, ManyBadPointsAreWarnedOf)
{
    auto o = mrptScan(kStart);
    for (std::size_t i = 0; i < 10; i++) o.point_cloud.x[i] = kNan;
    const auto log = read({o});
    EXPECT_EQ(log.scans.at(0).points.size(), 90u);
    ASSERT_EQ(log.warnings.count("scan_bad_points"), 1u);
    EXPECT_THAT(log.warnings.kept()[0].text, HasSubstr("10 points of 100"));
    EXPECT_EQ(log.warnings.kept()[0].t, kStart);
}

TEST_F(FilledCloud, ADroppedLastPointStillTellsTheEndOfTheSweep)
{
    auto o = mrptScan(kStart);
    o.point_cloud.x.back() = kNan;
    EXPECT_EQ(read({o}).scans.at(0).end, kStart + 99 * kMillisecond);
}

TEST_F(FilledCloud, PointsWithAnImpossibleTimeAreDroppedAndDoNotMoveTheEnd)
{
    auto o = mrptScan(kStart);
    for (std::size_t i = 0; i < 6; i++)
        o.point_cloud.timestamp[i] = mrptTime(kStart - 1'000'000'000'000);
    o.point_cloud.timestamp[50] = mrptTime(kStart + 5'000'000'000);
    const auto log = read({o});
    EXPECT_EQ(log.scans.at(0).points.size(), 93u);
    EXPECT_EQ(log.scans[0].end, kStart + 99 * kMillisecond);
    EXPECT_EQ(log.warnings.count("scan_bad_points"), 1u);
}

TEST_F(FilledCloud, PointsBeforeTheStampKeepTheirNegativeOffset)
{
    auto o = mrptScan(kStart);
    o.timestamp = mrptTime(kStart + 99 * kMillisecond);  // stamped at the end of the sweep
    const auto log = read({o});
    EXPECT_EQ(log.scans.at(0).points[0].offset, -99 * kMillisecond);
    EXPECT_EQ(log.scans[0].stamp, log.scans[0].end);
}

TEST_F(FilledCloud, ScansWithoutAnyPointAreSkipped)
{
    auto empty = mrptScan(kStart);
    empty.point_cloud.clear();
    auto invalid = mrptScan(kStart + 100 * kMillisecond);
    for (auto& x : invalid.point_cloud.x) x = kNan;
    const auto log = read({empty, invalid, mrptScan(kStart + 200 * kMillisecond)});
    EXPECT_EQ(log.scans.size(), 1u);
    EXPECT_EQ(log.progress.skipped, 2u);
    EXPECT_EQ(log.warnings.count("scan_empty"), 2u);
}

TEST_F(FilledCloud, VectorsOfDifferentLengthsAreSkipped)
{
    auto o = mrptScan(kStart);
    o.point_cloud.timestamp.pop_back();
    const auto log = read({o, mrptScan(kStart + 100 * kMillisecond)});
    EXPECT_EQ(log.scans.size(), 1u);
    EXPECT_EQ(log.warnings.count("scan_invalid"), 1u);
}

TEST_F(FilledCloud, EqualTimesMeanUndistortedAndAreSaidOnce)
{
    std::vector<CObservationVelodyneScan> scans;
    for (int k = 0; k < 5; k++)
    {
        scans.push_back(mrptScan(kStart + k * 100 * kMillisecond));
        auto& times = scans.back().point_cloud.timestamp;
        if (k % 2)
            times.clear();
        else
            for (auto& t : times) t = scans.back().timestamp;
    }
    const auto log = read(scans);
    ASSERT_EQ(log.scans.size(), 5u);
    for (const auto& scan : log.scans)
    {
        EXPECT_TRUE(scan.already_undistorted);
        EXPECT_EQ(scan.end, scan.stamp);
    }
    EXPECT_EQ(log.warnings.count("scan_undistorted"), 1u);
}

TEST_F(FilledCloud, WithoutLasersThereAreNoRings)
{
    auto o = mrptScan(kStart);
    o.point_cloud.laser_id.clear();
    o.point_cloud.intensity.clear();
    const auto log = read({o});
    EXPECT_EQ(log.scans.at(0).rings, 0);
    EXPECT_EQ(log.scans[0].points[5].intensity, 0);
}

class RawPackets : public RawlogTest
{
 protected:
    /** 152 firing sequences that begin `before_hour` ns before the full hour. */
    static std::vector<velodyne::Packet> packets(Duration before_hour)
    {
        velodyne::PacketWriter writer(velodyne::Model::Vlp16);
        const Time hour = kStart - kStart % 3'600'000'000'000;
        for (int i = 0; i < 152; i++)
            writer.add(
                hour - before_hour + i / 24 * 1'327'000 + i % 24 * 55'296, 0.2 * i,
                std::vector<velodyne::Cell>(16, {10, 9}));
        return writer.take(true);
    }
};

TEST_F(RawPackets, AreTimedFromTheStampOfTheObservationByTheClockOfTheSensor)
{
    RawlogWriter writer(path("a.rawlog"));
    PacketScan scan;
    scan.stamp = kStart;
    scan.packets = packets(3'000'000);  // the full hour falls between them
    scan.T_imu_lidar.p = Vector3d(1, 2, 3);
    writer.write(scan);
    writer.close();
    const auto log = readAll(path("a.rawlog"));
    ASSERT_EQ(log.scans.size(), 1u);
    const Scan& read = log.scans[0];
    EXPECT_EQ(read.rings, 16);
    EXPECT_EQ(read.T_imu_lidar.p, Vector3d(1, 2, 3));
    ASSERT_EQ(read.points.size(), 152u * 16);
    for (std::size_t i = 0; i < read.points.size(); i++)
    {
        const auto sequence = static_cast<std::int32_t>(i / 16);
        EXPECT_EQ(read.points[i].ring, i % 16);
        EXPECT_EQ(
            read.points[i].offset, sequence / 24 * 1'327'000 + sequence % 24 * 55'296 +
                                       static_cast<std::int32_t>(i % 16) * 2304);
    }
    EXPECT_EQ(read.end, kStart + read.points.back().offset);
    EXPECT_FALSE(read.already_undistorted);
}

TEST_F(RawPackets, ThatCannotBeDecodedAreSkippedWithTheCause)
{
    RawlogWriter writer(path("a.rawlog"));
    PacketScan scan;
    scan.stamp = kStart;
    scan.packets = packets(0);
    scan.packets[1].back() = 0x24;
    writer.write(scan);
    scan.stamp += 100 * kMillisecond;
    scan.packets = packets(0);
    writer.write(scan);
    writer.close();
    const auto log = readAll(path("a.rawlog"));
    EXPECT_EQ(log.scans.size(), 1u);
    ASSERT_EQ(log.warnings.count("scan_invalid"), 1u);
    EXPECT_THAT(log.warnings.kept()[0].text, HasSubstr("0x24"));
}

TEST_F(RawPackets, TakePrecedenceOverACloudThatMayHaveLostHalfOfThem)
{
    auto o = mrptScan(kStart);
    const auto raw = packets(0);
    o.scan_packets.resize(raw.size());
    for (std::size_t i = 0; i < raw.size(); i++)
        std::memcpy(&o.scan_packets[i], raw[i].data(), raw[i].size());
    o.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("VLP16");
    o.calibration.laser_corrections[3].verticalCorrection = 90;
    LogBytes log;
    writeFile(path("a.rawlog"), log.add(o).bytes());
    const auto content = readAll(path("a.rawlog"));
    ASSERT_EQ(content.scans.size(), 1u);
    EXPECT_EQ(content.scans[0].points.size(), 152u * 16);
    EXPECT_NEAR(content.scans[0].points[3].position.z(), 10, 1e-5);  // the log's own calibration
    EXPECT_EQ(content.scans[0].points[3].intensity, 9);
}
}  // namespace taut::test
