/** Rawlogs whose points have no times. */
#include <gmock/gmock.h>

#include "recording.h"
#include "taut/core/WarningLog.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
class ARawlogWithoutTimes : public testing::Test
{
 protected:
    ARawlogWithoutTimes() { write(Recording().imu()); }

    void write(const ImuSamples& imu)
    {
        RawlogWriter writer(path_);
        auto sample = imu.begin();
        for (Scan scan : scans_)
        {
            for (; sample != imu.end() && sample->t < scan.stamp; ++sample) writer.write(*sample);
            for (LidarPoint& point : scan.points) point.offset = 0;
            writer.write(scan);
        }
        for (; sample != imu.end(); ++sample) writer.write(*sample);
        writer.close();
    }

    std::vector<Scan> read(ScanTimes times)
    {
        RawlogConfig config;
        config.path = path_;
        config.scan_times = times;
        RawlogSource source(config, warnings_.sink());
        std::vector<Scan> scans;
        while (auto measurement = source.next())
            if (auto* scan = std::get_if<Scan>(&*measurement)) scans.push_back(std::move(*scan));
        return scans;
    }

    const TemporaryFolder folder_;
    const std::string path_ = folder_ / "a.rawlog";
    const std::vector<Scan> scans_ = Recording().scans();
    WarningLog warnings_;
};

TEST_F(ARawlogWithoutTimes, GetsThemFromTheAzimuthOfItsPoints)
{
    const auto scans = read(ScanTimes::Auto);
    ASSERT_EQ(scans.size(), scans_.size());
    EXPECT_EQ(warnings_.count("scan_times"), 1U);
    EXPECT_EQ(warnings_.count("scan_undistorted"), 0U);
    for (std::size_t k = 0; k < scans.size(); k++)
    {
        EXPECT_FALSE(scans[k].already_undistorted);
        ASSERT_EQ(scans[k].points.size(), scans_[k].points.size());
        for (std::size_t i = 0; i < scans[k].points.size(); i++)
            ASSERT_NEAR(
                toSeconds(
                    scans[k].timeOf(scans[k].points[i]) - scans_[k].timeOf(scans_[k].points[i])),
                0, 1.5e-3);
    }
}

TEST_F(ARawlogWithoutTimes, IsTakenAsUndistortedWithoutAnImu)
{
    write({});
    const auto scans = read(ScanTimes::Auto);
    ASSERT_EQ(scans.size(), scans_.size());
    EXPECT_TRUE(scans[20].already_undistorted);
    EXPECT_EQ(warnings_.count("scan_undistorted"), 1U);
    EXPECT_FALSE(read(ScanTimes::Azimuth)[20].already_undistorted);
}

TEST_F(ARawlogWithoutTimes, StaysAsItIsIfToldSo)
{
    const auto scans = read(ScanTimes::None);
    ASSERT_EQ(scans.size(), scans_.size());
    EXPECT_EQ(warnings_.count("scan_times"), 0U);
    EXPECT_EQ(warnings_.count("scan_undistorted"), 1U);
    EXPECT_TRUE(scans[20].already_undistorted);
    EXPECT_EQ(scans[20].end, scans_[20].stamp);
}
}  // namespace
}  // namespace taut::test
