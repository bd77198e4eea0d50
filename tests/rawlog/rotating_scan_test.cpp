#include <gmock/gmock.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include "mrpt_support.h"

namespace taut::test
{
using mrpt::obs::CObservationRotatingScan;
using testing::HasSubstr;

class RotatingScan : public RawlogTest
{
 protected:
    /** 3 rows by 8 columns over a full turn in 80 ms. */
    RotatingScan()
    {
        scan_.timestamp = mrptTime(kStart);
        scan_.sensorLabel = "OUSTER";
        scan_.lidarModel = "OS1";
        scan_.rowCount = 3;
        scan_.columnCount = 8;
        scan_.rangeResolution = 0.01;
        scan_.startAzimuth = M_PI;
        scan_.azimuthSpan = -2 * M_PI;
        scan_.sweepDuration = 0.08;
        scan_.rangeImage.setZero(3, 8);
        scan_.intensityImage.setZero(3, 8);
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 8; column++)
            {
                scan_.rangeImage(row, column) = static_cast<std::uint16_t>(1000 + column);
                scan_.intensityImage(row, column) = static_cast<std::uint8_t>(row);
            }
        config_.path = path("a.rawlog");
        config_.rig.lidar.row_elevations = {0.2, -0.2};
    }

    Content read() const
    {
        LogBytes log;
        writeFile(config_.path, log.add(scan_).bytes());
        return readAll(config_);
    }

    CObservationRotatingScan scan_;
    RawlogConfig config_;
};

TEST_F(RotatingScan, TakesDirectionAndTimeFromTheColumn)
{
    const auto log = read();
    ASSERT_EQ(log.scans.size(), 1u);
    const Scan& scan = log.scans[0];
    EXPECT_EQ(scan.rings, 3);
    ASSERT_EQ(scan.points.size(), 24u);
    for (std::size_t i = 0; i < 24; i++)
    {
        const auto& point = scan.points[i];
        const int column = static_cast<int>(i) / 3, row = static_cast<int>(i) % 3;
        EXPECT_EQ(point.ring, row);
        EXPECT_EQ(point.offset, column * 10 * kMillisecond);
        EXPECT_EQ(point.intensity, static_cast<float>(row));
        const double azimuth = M_PI - column * M_PI / 4, elevation = 0.2 - 0.2 * row;
        const double range = 10 + 0.01 * column;
        EXPECT_NEAR(point.position.x(), range * cos(elevation) * cos(azimuth), 1e-5);
        EXPECT_NEAR(point.position.y(), range * cos(elevation) * sin(azimuth), 1e-5);
        EXPECT_NEAR(point.position.z(), range * sin(elevation), 1e-5);
    }
    EXPECT_EQ(scan.end, kStart + 70 * kMillisecond);
}

TEST_F(RotatingScan, SpreadsASectorFromItsFirstToItsLastColumn)
{
    scan_.startAzimuth = -0.7;
    scan_.azimuthSpan = 1.4;
    scan_.rangeImage(1, 3) = 0;  // no return
    const auto scan = read().scans.at(0);
    ASSERT_EQ(scan.points.size(), 23u);
    EXPECT_EQ(scan.points.back().offset, 80 * kMillisecond);
    EXPECT_NEAR(
        std::atan2(scan.points.back().position.y(), scan.points.back().position.x()), 0.7, 1e-6);
}

TEST_F(RotatingScan, WithoutADurationIsUndistortedAlready)
{
    scan_.sweepDuration = 0;
    const auto log = read();
    EXPECT_TRUE(log.scans.at(0).already_undistorted);
    EXPECT_EQ(log.warnings.count("scan_undistorted"), 1u);
}

TEST_F(RotatingScan, OfUnknownElevationsIsSkippedWithTheCure)
{
    config_.rig = {};
    const auto log = read();
    EXPECT_TRUE(log.scans.empty());
    ASSERT_EQ(log.warnings.count("scan_invalid"), 1u);
    EXPECT_THAT(log.warnings.kept()[0].text, HasSubstr("row_elevations"));
}

TEST_F(RotatingScan, KnowsTheElevationsOfTheVlp16)
{
    config_.rig = {};
    scan_.lidarModel = "VLP-16";
    scan_.rowCount = 16;
    scan_.rangeImage.setZero(16, 8);
    scan_.intensityImage.resize(0, 0);
    scan_.rangeImage(15, 4) = 1000;
    const auto scan = read().scans.at(0);
    ASSERT_EQ(scan.points.size(), 1u);
    EXPECT_NEAR(scan.points[0].position.z(), 10 * std::sin(15 * M_PI / 180), 1e-5);
    EXPECT_EQ(scan.rings, 16);
}

TEST_F(RotatingScan, ThatContradictsItselfIsSkipped)
{
    scan_.columnCount = 9;
    EXPECT_EQ(read().warnings.count("scan_invalid"), 1u);
    scan_.columnCount = 8;
    scan_.azimuthSpan = std::nan("");
    EXPECT_EQ(read().warnings.count("scan_invalid"), 1u);
    scan_.azimuthSpan = 6;
    scan_.lidarModel = "HDL-32E";  // turns clockwise
    EXPECT_THAT(read().warnings.kept().at(0).text, HasSubstr("fromVelodyne"));
}
}  // namespace taut::test
