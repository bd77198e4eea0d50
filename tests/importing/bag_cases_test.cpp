/** What people's bags look like, after public reports: one bad value, a clock, a unit or a second
 * sensor must not decide for all. */
#include "bag_support.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

class AReportedBag : public testing::Test
{
 protected:
    /** Sweeps and readings in the order of arrival. */
    TestMessages messages(const CloudStyle& style) const
    {
        return merged(
            sweepMessages(scans_, style, TestWire::Cdr), readingMessages(readings_, TestWire::Cdr));
    }
    std::string write(const TestMessages& messages) const
    {
        writeFile(folder_ / "a.mcap", McapWriter::file(messages));
        return folder_ / "a.mcap";
    }
    Imported importStyle(const CloudStyle& style, const ImportOptions& options = {}) const
    {
        return import(write(messages(style)), options);
    }
    /** Without every n-th point of each sweep. */
    std::vector<Scan> withoutEvery(std::size_t n) const
    {
        auto scans = scans_;
        for (Scan& scan : scans)
        {
            std::vector<LidarPoint> kept;
            for (std::size_t i = 0; i < scan.points.size(); i++)
                if (i % n != 0) kept.push_back(scan.points[i]);
            scan.points = kept;
        }
        return scans;
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_ = syntheticSweeps(12, 400);
    ImuSamples readings_ = syntheticReadings(12);
};

CloudStyle secondsSince1970()
{
    CloudStyle style;
    style.time_name = "timestamp";
    style.time_type = "float64";
    style.time_unit = 1e9;
    style.absolute = true;
    return style;
}

TEST_F(AReportedBag, WithATimeOfZeroInSomePointsKeepsTheOthers)
{
    CloudStyle style = secondsSince1970();
    style.spoil = [](std::size_t i, double time) { return i % 500 == 0 ? 0 : time; };
    const auto want = withoutEvery(500);
    const Imported result = importStyle(style);
    expectSame(result.scans, want, 300);
    EXPECT_THAT(result.findings, HasSubstr("timestamp (float64) in s"));
    EXPECT_THAT(result.findings, HasSubstr("points have a time outside of their sweep"));
}

TEST_F(AReportedBag, WithGarbageInTheFirstCloudKeepsItsStamps)
{
    CloudStyle style;
    style.time_name = "time";
    style.time_type = "float32";
    style.time_unit = 1e9;
    style.stamp_at = 1;
    auto all = messages(style);
    style.spoil = [](std::size_t i, double time) { return i < 3 ? 1e9 : time; };
    const auto first = std::find_if(
        all.begin(), all.end(), [](const TestMessage& m) { return m.topic == kLidarTopic; });
    first->data = CloudWriter(scans_[0], style, TestWire::Cdr).message();
    auto want = scans_;
    want[0].points.erase(want[0].points.begin(), want[0].points.begin() + 3);
    const Imported result = import(write(all));
    expectSame(result.scans, want, 10);
    EXPECT_THAT(result.findings, HasSubstr("its end"));
    EXPECT_THAT(result.findings, HasSubstr("3 of "));
}

TEST_F(AReportedBag, WithTimesOfTheSweepBeforeInSomePointsDropsThese)
{
    CloudStyle style;
    style.spoil = [](std::size_t i, double time) { return i % 100 == 99 ? time + 250e6 : time; };
    auto want = scans_;
    for (Scan& scan : want)
    {
        std::vector<LidarPoint> kept;
        for (std::size_t i = 0; i < scan.points.size(); i++)
            if (i % 100 != 99) kept.push_back(scan.points[i]);
        scan.points = kept;
        scan.end = scan.timeOf(kept.back());
    }
    expectSame(importStyle(style).scans, want, 0);
}

TEST_F(AReportedBag, WithAStampAnHourAheadLosesThatOneAlone)
{
    for (const std::size_t which : {std::size_t{0}, std::size_t{40}})
    {
        auto readings = readings_;
        readings[which].t += Duration{3600} * 1'000'000'000;
        auto all = merged(
            sweepMessages(scans_, {}, TestWire::Cdr), readingMessages(readings_, TestWire::Cdr));
        std::size_t n = 0;
        for (TestMessage& m : all)
            if (m.topic == kImuTopic && n++ == which)
                m.data = imuMessage(readings[which], TestWire::Cdr);
        const Imported result = import(write(all));
        EXPECT_EQ(result.readings.size(), readings_.size() - 1) << which;
        EXPECT_EQ(result.warnings.count("stamp_outlier"), 1u);
        expectSame(result.scans, scans_, 0);
    }
}

TEST_F(AReportedBag, WithoutStampsUsesTimesSince1970)
{
    CloudStyle style = secondsSince1970();
    style.stamped = false;
    const Imported result = importStyle(style);
    expectSame(result.scans, scans_, 300);
    EXPECT_EQ(result.warnings.count("no_stamp"), 0u);
    EXPECT_THAT(result.findings, HasSubstr("most are zero"));
}

class ATimeField : public AReportedBag, public testing::WithParamInterface<const char*>
{
};

TEST_P(ATimeField, IsFoundByWhatItsNameLooksLike)
{
    const std::string name = GetParam();
    CloudStyle style;
    style.time_name = name;
    style.time_type = name == "Time" ? "float32" : "uint32";
    style.time_unit = name == "Time" ? 1e9 : name.find("_us") != std::string::npos ? 1e3 : 1;
    const Imported result = importStyle(style);
    expectSame(result.scans, scans_, name == "Time" ? 10 : 0);
    EXPECT_THAT(result.findings, HasSubstr(name + " ("));
}

INSTANTIATE_TEST_SUITE_P(
    Names, ATimeField,
    testing::Values("time_offset_ns", "stamps", "ts", "Time", "t_us", "scalar_GpsTime"));

TEST_F(AReportedBag, WithSeveralUnknownTimesNamesThemAndAsks)
{
    CloudStyle style;
    style.time_name = "shot_time";
    style.more_fields = {"laser_stamp", "dropped_time"};
    const std::string path = write(messages(style));
    EXPECT_THAT(
        failure(path), testing::AllOf(
                           HasSubstr("'shot_time', 'laser_stamp', 'dropped_time'"),
                           HasSubstr("--time-field chooses")));
    ImportOptions options;
    options.time_field = "shot_time";
    expectSame(import(path, options).scans, scans_, 0);
    options.time_field = "none";
    EXPECT_TRUE(import(path, options).scans.at(0).already_undistorted);
    options.time_field = "shot_tim";
    EXPECT_THAT(failure(path, options), HasSubstr("'shot_tim' is no field of the points"));
}

TEST_F(AReportedBag, WithTooFewDigitsIsRefusedUntilToldToGoWithout)
{
    for (const double second : {50'000.0, 300'000.0})  // of the day, of the week
    {
        CloudStyle style = secondsSince1970();
        style.time_type = "float32";
        style.clock_shift = -kBagStart + fromSeconds(second);
        const std::string path = write(messages(style));
        EXPECT_THAT(
            failure(path),
            testing::AllOf(HasSubstr("timestamp (float32)"), HasSubstr("too coarse")));
        ImportOptions options;
        options.time_field = "none";
        EXPECT_EQ(import(path, options).scans.size(), scans_.size());
    }
}
}  // namespace
}  // namespace taut::test
