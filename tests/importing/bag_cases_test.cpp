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
    EXPECT_THAT(result.findings, HasSubstr("most have none"));
}

TEST_F(AReportedBag, WithIntensitiesUpToOneScalesThem)
{
    CloudStyle style;
    style.intensity_scale = 1 / 255.0;
    const Imported result = importStyle(style);
    ASSERT_EQ(result.scans.size(), scans_.size());
    EXPECT_THAT(result.findings, HasSubstr("intensity: from 0 to 1, times 255"));
    for (std::size_t i = 0; i < scans_[3].points.size(); i++)
        ASSERT_NEAR(result.scans[3].points[i].intensity, scans_[3].points[i].intensity, 1e-3);
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
    options.scan_times = ScanTimes::None;
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

/** A bag that a script wrote topic by topic, the clouds first. */
TestMessages topicByTopic(TestMessages clouds, const TestMessages& readings)
{
    clouds.insert(clouds.end(), readings.begin(), readings.end());
    return clouds;
}

TEST_F(AReportedBag, WrittenTopicByTopicIsReadInTheOrderOfTime)
{
    for (const double gravity : {9.81, 1.0})
        for (const std::string times : {"recorder", "script", "none"})
        {
            SCOPED_TRACE(times);
            const auto readings = syntheticReadings(12, gravity);
            auto all = topicByTopic(
                sweepMessages(scans_, {}, TestWire::Cdr), readingMessages(readings, TestWire::Cdr));
            Time written = kBagStart + 1'000'000'000'000;
            for (TestMessage& m : all)
                if (times != "recorder") m.received = times == "none" ? 0 : written += 1'000'000;
            ImportOptions options;
            const auto source = openImportSource(write(all), options, {});
            std::optional<Time> last_sample;
            std::size_t scans = 0, samples = 0;
            while (const auto item = source->next())
                if (const auto* scan = std::get_if<Scan>(&*item))
                {
                    scans++;
                    ASSERT_TRUE(last_sample);
                    EXPECT_LT(std::abs(*last_sample - scan->stamp), 300'000'000);
                }
                else
                {
                    const auto& sample = std::get<ImuSample>(*item);
                    last_sample = sample.t;
                    samples++;
                    EXPECT_NEAR(sample.accel.z(), gravity == 1 ? 9.80665 : 9.81, 1e-9);
                }
            EXPECT_EQ(scans, scans_.size());
            EXPECT_EQ(samples, readings.size());
        }
}

TEST_F(AReportedBag, WhoseClocksWereSetBackStaysInOrder)
{
    scans_ = syntheticSweeps(60, 20);
    readings_ = syntheticReadings(60);
    const Duration back = 3'600'000'000'000;
    const Time since = scans_[40].stamp;
    auto scans = scans_;
    auto readings = readings_;
    for (Scan& scan : scans)
        if (scan.stamp >= since)
        {
            scan.stamp -= back;
            scan.end -= back;
        }
    for (ImuSample& sample : readings)
        if (sample.t >= since) sample.t -= back;
    const auto before = [&](const TestMessage& m)
    { return m.received > since - back + 10'000'000'000; };
    auto all =
        merged(sweepMessages(scans, {}, TestWire::Cdr), readingMessages(readings, TestWire::Cdr));
    std::stable_partition(all.begin(), all.end(), before);
    const Imported result = import(write(all));
    EXPECT_EQ(result.readings.size(), readings.size());
    EXPECT_EQ(result.warnings.count("clock_back"), 2u);
    ASSERT_EQ(result.scans.size(), scans.size());
    for (std::size_t k = 0; k < scans.size(); k++)
        EXPECT_LE(std::abs(result.scans[k].stamp - scans_[k].stamp), 20'000'000);
}

TEST_F(AReportedBag, OfClocksThatDifferSaysByHowMuchAndWhatCorrectsIt)
{
    auto scans = scans_;
    for (Scan& scan : scans) scan.stamp += 37'000'000'000;
    auto clouds = sweepMessages(scans, {}, TestWire::Cdr);
    for (std::size_t k = 0; k < clouds.size(); k++) clouds[k].received = arrivalOf(scans_[k]);
    const std::string path = write(merged(clouds, readingMessages(readings_, TestWire::Cdr)));
    const Imported result = import(path);
    EXPECT_EQ(result.scans.size(), scans.size());
    ASSERT_EQ(result.warnings.count("clock_offset"), 1u);
    EXPECT_THAT(
        result.warnings.kept().at(0).text,
        testing::AllOf(
            HasSubstr("ahead of those of the IMU"), HasSubstr("TAI is ahead of UTC by: 37 s"),
            HasSubstr("clock_offset: -36.9")));
    ImportOptions options;
    options.lidar_clock_offset = -37;
    EXPECT_EQ(import(path, options).warnings.count("clock_offset"), 0u);
}

TEST_F(AReportedBag, OfTwoSensorsOnOneTopicNamesThemAndTakesTheOneAskedFor)
{
    TestMessages livox, clouds;
    for (std::size_t k = 0; k < scans_.size(); k++)
    {
        const int id = static_cast<int>(k % 2);
        livox.push_back(
            {kLidarTopic, "livox_ros_driver2/CustomMsg", arrivalOf(scans_[k]),
             livoxMessage(scans_[k], TestWire::Cdr, 0, id)});
        CloudStyle style;
        style.frame = id == 0 ? "front" : "rear";
        const Scan& scan = scans_[k];
        clouds.push_back(
            {kLidarTopic, "sensor_msgs/PointCloud2", arrivalOf(scan),
             CloudWriter(scan, style, TestWire::Cdr).message()});
    }
    std::vector<Scan> seconds;
    for (std::size_t k = 1; k < scans_.size(); k += 2) seconds.push_back(scans_[k]);
    for (const bool is_livox : {true, false})
    {
        const std::string path = write(is_livox ? livox : clouds);
        EXPECT_THAT(
            failure(path), testing::AllOf(
                               HasSubstr(is_livox ? "'0', '1'" : "'front', 'rear'"),
                               HasSubstr("--lidar-id chooses")));
        ImportOptions options;
        options.lidar_id = is_livox ? "1" : "re.*";
        const Imported result = import(path, options);
        expectSame(result.scans, seconds, 0);
        EXPECT_EQ(result.warnings.count("second_sensor"), 1u);
        options.lidar_id = "2";
        EXPECT_THAT(failure(path, options), HasSubstr("'2' is no sensor"));
    }
}

TEST_F(AReportedBag, WithOneSweepOfAnotherSensorLeavesItOut)
{
    auto all = messages({});
    CloudStyle style;
    style.frame = "camera";
    all.insert(
        all.begin() + 20, {kLidarTopic, "sensor_msgs/PointCloud2", all[20].received,
                           CloudWriter(scans_[3], style, TestWire::Cdr).message()});
    const Imported result = import(write(all));
    expectSame(result.scans, scans_, 0);
    EXPECT_EQ(result.warnings.count("second_sensor"), 1u);
}

TEST_F(AReportedBag, WhoseRecorderWasRestartedHasOneTopicOfTwoConnections)
{
    const auto all = messages({});
    ContainerStyle style;
    style.connections = 2;
    writeFile(folder_ / "a.mcap", McapWriter::file(all, style));
    const auto ros1 = merged(
        sweepMessages(scans_, {}, TestWire::Ros1), readingMessages(readings_, TestWire::Ros1));
    writeFile(folder_ / "a.bag", Ros1Writer::bag(ros1, style));
    writeSqlite3Bag(folder_ / "a.db3", all, style);
    for (const std::string name : {"a.mcap", "a.bag", "a.db3"})
    {
        SCOPED_TRACE(name);
        const Imported result = import(folder_ / name);
        expectSame(result.scans, scans_, 0);
        EXPECT_EQ(result.readings.size(), readings_.size());
    }
}

TEST_F(AReportedBag, WithTheSummaryInAnotherOrderIsReadTheSame)
{
    ContainerStyle style;
    style.channels_first = true;
    writeFile(folder_ / "a.mcap", McapWriter::file(messages({}), style));
    expectSame(import(folder_ / "a.mcap").scans, scans_, 0);
}

TEST_F(AReportedBag, WithoutASerializationFormatIsReadAsCdr)
{
    ContainerStyle style;
    style.serialization = "";
    writeSqlite3Bag(folder_ / "a.db3", messages({}), style);
    expectSame(import(folder_ / "a.db3").scans, scans_, 0);
}

TEST_F(AReportedBag, WithoutAnImuForTheFirstSecondsJudgesItsUnitsAllTheSame)
{
    scans_ = syntheticSweeps(60, 20);
    const auto readings = syntheticReadings(60, 1.0);
    ImuSamples late(readings.begin() + 400, readings.end());
    const Imported result = import(write(
        merged(sweepMessages(scans_, {}, TestWire::Cdr), readingMessages(late, TestWire::Cdr))));
    ASSERT_EQ(result.readings.size(), late.size());
    EXPECT_NEAR(result.readings[0].accel.z(), 9.80665, 1e-9);
}
}  // namespace
}  // namespace taut::test
