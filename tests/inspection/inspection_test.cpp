#include "taut/inspection/Inspection.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "recording.h"
#include "taut/odometry/registerAll.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kStart = 1'700'000'000 * kSecond;

/** A log of 12 s at rest, to be spoiled and then written in the order of time. */
struct MadeUpLog
{
    ImuSamples imu;
    std::vector<Scan> scans;

    MadeUpLog()
    {
        taut::test::Random random(7);
        for (int i = 0; i < 1200; i++)
            imu.push_back(
                {kStart + i * 10 * kMillisecond, random.vector(1e-3),
                 random.vector(1e-2) + Vector3d(0, 0, 9.81)});
        for (int k = 0; k < 119; k++) scans.push_back(scanAt(kStart + k * 100 * kMillisecond));
    }

    static Scan scanAt(Time stamp)
    {
        Scan scan;
        scan.stamp = stamp;
        for (int i = 0; i < 100; i++)
        {
            LidarPoint p;
            p.position = {5, 0.1f * static_cast<float>(i), 1};
            p.offset = static_cast<std::int32_t>(i * kMillisecond);
            p.ring = static_cast<std::uint16_t>(i % 4);
            scan.points.push_back(p);
        }
        scan.end = stamp + scan.points.back().offset;
        return scan;
    }

    /** Each scan follows the samples of its sweep. */
    void write(const std::string& path) const
    {
        RawlogWriter writer(path);
        std::size_t next = 0;
        for (std::size_t k = 0; k < scans.size(); k++)
        {
            for (; next < imu.size() && next < 10 * (k + 1); next++) writer.write(imu[next]);
            writer.write(scans[k]);
        }
        for (; next < imu.size(); next++) writer.write(imu[next]);
        writer.close();
    }
};

class Doctor : public testing::Test
{
 protected:
    Doctor() { registerAll(); }

    Inspection inspect(InspectionConfig config) const
    {
        config.log.path = path_;
        Executor executor(1);
        return inspectRecording(config, executor);
    }

    std::vector<std::string> kindsIn(const MadeUpLog& log) const
    {
        log.write(path_);
        return kindsOf(inspect(without_matching_).findings);
    }

    static std::vector<std::string> kindsOf(const Findings& findings)
    {
        std::vector<std::string> kinds;
        for (const Finding& f : findings)
        {
            EXPECT_FALSE(f.text.empty()) << f.kind;
            EXPECT_FALSE(f.advice.empty()) << f.kind;
            kinds.push_back(f.kind);
        }
        return kinds;
    }

    const TemporaryFolder folder_;
    const std::string path_ = folder_ / "log.rawlog";
    const InspectionConfig without_matching_ = []
    {
        InspectionConfig c;
        c.match_scans = false;
        return c;
    }();
    MadeUpLog log_;
};

TEST_F(Doctor, FindsNothingInACleanLog)
{
    EXPECT_THAT(kindsIn(log_), IsEmpty());
    InspectionConfig config;
    const Inspection i = inspect(config);
    EXPECT_THAT(kindsOf(i.findings), IsEmpty());
    EXPECT_EQ(i.log.scans, 119U);
    EXPECT_EQ(i.lidar->scans, 119U);
    EXPECT_EQ(i.imu->samples, 1200U);
    EXPECT_EQ(i.log.lidar_label, "LIDAR");
    ASSERT_TRUE(i.rotation);
    EXPECT_NE(i.rotation->not_estimated, "");
    EXPECT_FALSE(i.incomplete);
}

TEST_F(Doctor, FindsStampsThatRepeatOrGoBackward)
{
    log_.imu[500].t = log_.imu[499].t;
    log_.imu[700].t = log_.imu[690].t + 1000;
    log_.scans[30].stamp = log_.scans[29].stamp;
    log_.scans[50].stamp -= 250 * kMillisecond;
    log_.write(path_);
    const Findings found = inspect(without_matching_).findings;
    EXPECT_THAT(
        kindsOf(found),
        UnorderedElementsAre(
            "imu_duplicate", "imu_order", "scan_duplicate", "scan_time", "lidar_gap"));
    for (const Finding& f : found)
        if (f.kind == "imu_duplicate")
        {
            EXPECT_EQ(f.t, log_.imu[500].t);
        }
}

TEST_F(Doctor, FindsGapsOfBothSensors)
{
    log_.imu.erase(log_.imu.begin() + 600, log_.imu.begin() + 650);
    log_.scans.erase(log_.scans.begin() + 60, log_.scans.begin() + 65);
    EXPECT_THAT(kindsIn(log_), UnorderedElementsAre("imu_gap", "lidar_gap"));
}

TEST_F(Doctor, FindsPointsThatAreNotFinite)
{
    for (int i = 0; i < 3; i++)
        log_.scans[20].points[i].position.y() = std::numeric_limits<float>::quiet_NaN();
    log_.write(path_);
    const Findings found = inspect(without_matching_).findings;
    ASSERT_THAT(kindsOf(found), ElementsAre("nan_points"));
    EXPECT_NEAR(found[0].value, 100 * 3 / 11900.0, 1e-9);
    EXPECT_NEAR(toSeconds(found[0].t - kStart), 2, 0.2);
}

TEST_F(Doctor, FindsEmptyScans)
{
    log_.scans[20].points.clear();
    log_.scans[70].points.clear();
    log_.write(path_);
    const Findings found = inspect(without_matching_).findings;
    EXPECT_THAT(kindsOf(found), UnorderedElementsAre("scan_empty", "lidar_gap"));
    for (const Finding& f : found)
    {
        EXPECT_EQ(f.count, 2U) << f.kind;
        EXPECT_NEAR(toSeconds(f.t - log_.scans[20].stamp), 0, 0.11) << f.kind;
    }
}

TEST_F(Doctor, FindsPointsWhoseTimesAreOfAnotherClock)
{
    for (LidarPoint& p : log_.scans[20].points)
        if (p.ring == 1) p.offset = 2'100'000'000;
    EXPECT_THAT(kindsIn(log_), ElementsAre("point_times"));
}

TEST_F(Doctor, FindsScansWithoutTimes)
{
    for (Scan& scan : log_.scans)
        for (LidarPoint& p : scan.points) p.offset = 0;
    EXPECT_THAT(kindsIn(log_), ElementsAre("scan_undistorted"));
    const Inspection i = inspect({});
    ASSERT_TRUE(i.rotation);
    EXPECT_THAT(i.rotation->not_estimated, testing::HasSubstr("undistorted"));
}

TEST_F(Doctor, FindsOtherUnits)
{
    for (ImuSample& s : log_.imu) s.accel /= 9.80665;
    EXPECT_THAT(kindsIn(log_), ElementsAre("imu_units"));
}

TEST_F(Doctor, MissesTheImu)
{
    log_.imu.clear();
    EXPECT_THAT(kindsIn(log_), ElementsAre("no_imu"));
    EXPECT_FALSE(inspect({}).rotation);
}

TEST_F(Doctor, TellsOfTheImuEvenWithoutALidar)
{
    log_.scans.clear();
    log_.write(path_);
    const Inspection i = inspect({});
    ASSERT_THAT(kindsOf(i.findings), ElementsAre("unreadable"));
    EXPECT_THAT(i.findings[0].text, testing::HasSubstr("no LiDAR"));
    EXPECT_EQ(i.imu->samples, 1200U);
    EXPECT_FALSE(i.lidar);
}

TEST_F(Doctor, FindsScansThatTheImuDoesNotCover)
{
    log_.imu.erase(log_.imu.begin() + 1050, log_.imu.end());
    const auto kinds = kindsIn(log_);
    EXPECT_THAT(kinds, ElementsAre("imu_coverage"));
}

TEST_F(Doctor, FindsClocksThatShareNoTime)
{
    for (Scan& scan : log_.scans) scan.stamp -= 3600 * kSecond;
    log_.write(path_);
    const Inspection i = inspect({});
    ASSERT_THAT(kindsOf(i.findings), Contains("clocks_apart"));
    for (const Finding& f : i.findings)
        if (f.kind == "clocks_apart")
        {
            EXPECT_NEAR(f.value, 3600, 1e-3);
        }
}

TEST_F(Doctor, ReadsADamagedLogUpToTheDamage)
{
    log_.write(path_);
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
    const Inspection i = inspect(without_matching_);
    EXPECT_THAT(kindsOf(i.findings), Contains("rawlog_truncated"));
    EXPECT_TRUE(i.incomplete);
    EXPECT_GT(i.lidar->scans, 20U);
    EXPECT_LT(i.lidar->scans, 90U);
}

TEST_F(Doctor, ThrowsWhereNothingCanBeRead)
{
    EXPECT_THROW(inspect({}), std::runtime_error);
    std::ofstream(path_) << "not a rawlog at all";
    EXPECT_THROW(inspect({}), std::runtime_error);
}

TEST_F(Doctor, TakesThePartAndTheFactsOfTheRig)
{
    for (ImuSample& s : log_.imu) s.accel /= 9.80665;
    log_.imu[100].t = log_.imu[99].t;
    log_.write(path_);
    InspectionConfig config = without_matching_;
    config.log.rig.imu.accel_scale = 9.80665;
    config.log.from_time = 1.5;
    EXPECT_THAT(kindsOf(inspect(config).findings), ElementsAre());
}

TEST_F(Doctor, SurvivesValuesThatNoSensorGives)
{
    for (const double huge : {1e3, 1e20, 1e200})
    {
        for (std::size_t i = 600; i < 610; i++) log_.imu[i].gyro.x() = huge;
        log_.imu[800].accel.y() = -huge;
        log_.write(path_);
        InspectionConfig config;
        config.window = 3;
        EXPECT_THAT(kindsOf(inspect(config).findings), Contains("imu_outlier"));
    }
}

TEST_F(Doctor, MatchesTheWindowThatTurnsMostAndFindsTheClock)
{
    Recording recording;
    recording.rest = 10.5;
    recording.duration = 17;
    recording.columns = 180;
    const ImuSamples imu = recording.imu();
    RawlogWriter writer(path_);
    std::size_t next = 0;
    for (const Scan& scan : recording.scans())
    {
        for (; next < imu.size() && imu[next].t <= scan.end; next++)
        {
            ImuSample s = imu[next];
            s.t += 7 * kMillisecond;
            writer.write(s);
        }
        writer.write(scan);
    }
    writer.close();
    InspectionConfig config;
    config.window = 6;
    double share = 0;
    config.log.path = path_;
    Executor executor(1);
    const Inspection i = inspectRecording(
        config, executor,
        [&share](double now, std::size_t, double)
        {
            EXPECT_GE(now, share);
            share = now;
        });
    EXPECT_LE(share, 1);
    ASSERT_THAT(kindsOf(i.findings), ElementsAre("clock_offset"));
    EXPECT_NEAR(i.findings[0].value, 0.007, 1e-3);
    EXPECT_GE(i.rotation->begin, recording.start + 10 * kSecond);
    EXPECT_LE(toSeconds(i.rotation->end - i.rotation->begin), 6.2);
}
}  // namespace
