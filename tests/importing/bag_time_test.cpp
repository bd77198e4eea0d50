/** What the times of points and the stamps of clouds mean is found out and told. */
#include <ostream>

#include "bag_support.h"
#include "recording.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

struct TimeCase
{
    const char* name;
    CloudStyle style;
    Duration tolerance;  //!< the resolution of the field [ns]
    const char* finding;
};

void PrintTo(const TimeCase& time, std::ostream* out)
{
    *out << time.name;
}

CloudStyle style(
    const char* name, const char* type, double unit, bool absolute = false, double stamp_at = 0)
{
    CloudStyle s;
    s.time_name = name;
    s.time_type = type;
    s.time_unit = unit;
    s.absolute = absolute;
    s.stamp_at = stamp_at;
    return s;
}

const std::vector<TimeCase> kTimeCases{
    {"Ouster", style("t", "uint32", 1), 0, "t (uint32) in ns"},
    {"Velodyne", style("time", "float32", 1e9), 10, "time (float32) in s"},
    {"VelodyneStampedAtTheEnd", style("time", "float32", 1e9, false, 1), 10, "its end"},
    {"Hesai", style("timestamp", "float64", 1e9, true), 300, "timestamp (float64) in s"},
    {"RoboSenseStampedAtTheEnd", style("timestamp", "float64", 1e9, true, 1), 300, "its end"},
    {"LivoxCloud", style("timestamp", "float64", 1, true), 256, "timestamp (float64) in ns"},
    {"OffsetTime", style("offset_time", "uint32", 1), 0, "offset_time (uint32) in ns"},
    {"Microseconds", style("time", "float32", 1e3), 10, "in us, not in s as usual"},
    {"IntegerMicroseconds", style("t", "uint32", 1e3), 0, "in us, not in ns as usual"},
    {"Milliseconds", style("time", "float32", 1e6), 10, "in ms, not in s as usual"},
    {"StampInTheMiddle", style("time", "float32", 1e9, false, 0.5), 10, "at 50 % of it"},
};

class PointTimes : public testing::TestWithParam<TimeCase>
{
};

TEST_P(PointTimes, AreReadInTheUnitOfTheirField)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(12);
    const auto messages = merged(
        sweepMessages(scans, GetParam().style, TestWire::Cdr),
        readingMessages(syntheticReadings(12), TestWire::Cdr));
    writeFile(folder / "a.mcap", McapWriter::file(messages));
    const Imported result = import(folder / "a.mcap");
    expectSame(result.scans, scans, GetParam().tolerance);
    EXPECT_THAT(result.findings, HasSubstr(GetParam().finding));
    EXPECT_TRUE(result.warnings.counts().empty()) << result.warnings.counts().begin()->first;
}

INSTANTIATE_TEST_SUITE_P(
    Fields, PointTimes, testing::ValuesIn(kTimeCases), testing::PrintToStringParamName());

/** Bags of clouds without an IMU. */
class ABagOfClouds : public testing::Test
{
 protected:
    Imported importStyle(const CloudStyle& s, const ImportOptions& options = {})
    {
        return importMessages(sweepMessages(scans_, s, TestWire::Ros1), options);
    }
    Imported importMessages(const TestMessages& messages, const ImportOptions& options = {})
    {
        writeFile(folder_ / "a.bag", Ros1Writer::bag(messages));
        return import(folder_ / "a.bag", options);
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_ = syntheticSweeps(12);
};

TEST_F(ABagOfClouds, KeepsTheStampWhereThePointsHaveAnotherClock)
{
    CloudStyle s = style("timestamp", "float64", 1e9, true);
    s.clock_shift = -1'600'000'000'000'000'000;  // since the start of the sensor
    const Imported start = importStyle(s);
    expectSame(start.scans, scans_, 20);
    EXPECT_THAT(start.findings, HasSubstr("another clock"));
    EXPECT_THAT(start.findings, HasSubstr("as the time of the first point"));

    s.stamp_at = 1;
    const Imported end = importStyle(s);
    expectSame(end.scans, scans_, 20);
    EXPECT_THAT(end.findings, HasSubstr("as the time of the last point"));
}

TEST_F(ABagOfClouds, WarnsWhereNothingTellsWhichEndTheStampIs)
{
    CloudStyle s = style("timestamp", "float64", 1e9, true);
    s.clock_shift = -1'600'000'000'000'000'000;
    auto messages = sweepMessages(scans_, s, TestWire::Ros1);
    for (std::size_t i = 0; i < messages.size(); i++) messages[i].received = scans_[i].stamp;
    EXPECT_EQ(importMessages(messages).warnings.count("scan_stamp"), 1u);

    ImportOptions options;
    options.scan_stamp = ScanStamp::Start;
    const Imported told = importMessages(messages, options);
    EXPECT_EQ(told.warnings.count("scan_stamp"), 0u);
    expectSame(told.scans, scans_, 20);
}

TEST_F(ABagOfClouds, WarnsWhereSweepsArriveBeforeTheyEnd)
{
    // The driver counts from the first point but stamps the last.
    auto messages = sweepMessages(scans_, {}, TestWire::Ros1);
    auto shifted = scans_;
    for (auto& scan : shifted)
    {
        scan.stamp -= 100'000'000;
        scan.end -= 100'000'000;
    }
    for (std::size_t i = 0; i < messages.size(); i++) messages[i].received = arrivalOf(shifted[i]);
    EXPECT_EQ(importMessages(messages).warnings.count("scan_stamp"), 1u);

    ImportOptions options;
    options.scan_stamp = ScanStamp::End;
    const Imported told = importMessages(messages, options);
    EXPECT_EQ(told.warnings.count("scan_stamp"), 0u);
    expectSame(told.scans, shifted, 2'000'000);  // the stamp is a column later than the last point
}

TEST_F(ABagOfClouds, WithoutTimesIsTakenAsUndistortedAndSaysSo)
{
    const Imported result = importStyle(style("", "", 1));
    ASSERT_EQ(result.scans.size(), scans_.size());
    EXPECT_TRUE(result.scans[3].already_undistorted);
    EXPECT_EQ(result.scans[3].stamp, scans_[3].stamp);
    EXPECT_THAT(result.findings, HasSubstr("have no times"));
}

TEST_F(ABagOfClouds, WithTheSameTimeForAllPointsIsTakenAsUndistorted)
{
    for (auto& scan : scans_)
        for (auto& point : scan.points) point.offset = 0;
    const Imported result = importStyle({});
    ASSERT_EQ(result.scans.size(), scans_.size());
    EXPECT_TRUE(result.scans[3].already_undistorted);
    EXPECT_THAT(result.findings, HasSubstr("all have the same time"));
}

TEST_F(ABagOfClouds, WithTimesOfNoSweepFails)
{
    CloudStyle s = style("t", "float64", 1e-6);
    writeFile(folder_ / "a.bag", Ros1Writer::bag(sweepMessages(scans_, s, TestWire::Ros1)));
    EXPECT_THAT(failure(folder_ / "a.bag"), HasSubstr("no duration of a sweep in any unit"));
}

TEST_F(ABagOfClouds, LeavesOutAPointWithAnImpossibleTime)
{
    scans_[4].points[7].offset = 2'000'000'000;
    const Imported result = importStyle({});
    EXPECT_EQ(result.scans[4].points.size(), scans_[4].points.size() - 1);
    EXPECT_EQ(result.scans[4].end, scans_[4].end);
}

TEST_F(ABagOfClouds, WarnsWhereManyPointsHaveAnImpossibleTime)
{
    for (std::size_t i = 0; i < 20; i++) scans_[4].points[i].offset = 2'000'000'000;
    const Imported result = importStyle({});
    EXPECT_EQ(result.scans[4].points.size(), scans_[4].points.size() - 20);
    EXPECT_EQ(result.warnings.count("scan_bad_points"), 1u);
}

TEST_F(ABagOfClouds, LeavesOutSweepsWhoseStampsGoBackward)
{
    auto messages = sweepMessages(scans_, {}, TestWire::Ros1);
    std::swap(messages[6], messages[7]);
    const Imported result = importMessages(messages);
    EXPECT_EQ(result.scans.size(), scans_.size() - 1);
    EXPECT_EQ(result.warnings.count("scan_time"), 1u);
}

TEST_F(ABagOfClouds, ReadsOtherLayouts)
{
    CloudStyle s;
    s.big_endian_data = true;
    s.intensity_name = "reflectivity";
    s.ring_name = "line";
    s.ring_type = "uint8";
    s.rows = 4;
    expectSame(importStyle(s).scans, scans_, 0);
}

TEST_F(ABagOfClouds, DropsPointsThatAreNone)
{
    CloudStyle s;
    s.with_holes = true;
    const Imported result = importStyle(s);
    expectSame(result.scans, scans_, 0);
    EXPECT_EQ(result.warnings.count("scan_bad_points"), 0u);  // a NaN is how ROS says "no return"
}

/* Stamped at the start and a row for each laser; or at the end and as measured. */
TEST(ABagWithoutTimes, GetsThemFromTheAzimuthAndTheRecorder)
{
    const TemporaryFolder folder;
    for (const bool organised : {true, false})
    {
        auto scans = Recording().scans();
        CloudStyle s = style("", "", 1, false, organised ? 0 : 1);
        s.rows = organised ? 16 : 1;
        for (Scan& scan : scans)
            if (organised)
                std::stable_sort(
                    scan.points.begin(), scan.points.end(),
                    [](const LidarPoint& a, const LidarPoint& b) { return a.ring < b.ring; });
        writeFile(folder / "a.bag", Ros1Writer::bag(sweepMessages(scans, s, TestWire::Ros1)));
        const Imported result = import(folder / "a.bag");
        EXPECT_THAT(
            result.findings,
            HasSubstr(
                organised ? "its start, for it was recorded" : "its end, for it was recorded"));
        EXPECT_EQ(result.warnings.count("scan_stamp"), 0u);
        ASSERT_EQ(result.scans.size(), scans.size());
        for (std::size_t k = 0; k < scans.size(); k++)
        {
            ASSERT_EQ(result.scans[k].points.size(), scans[k].points.size());
            for (std::size_t i = 0; i < scans[k].points.size(); i++)
                ASSERT_NEAR(
                    toSeconds(
                        result.scans[k].timeOf(result.scans[k].points[i]) -
                        scans[k].timeOf(scans[k].points[i])),
                    0, 1.5e-3);
        }
        ImportOptions none;
        none.scan_times = ScanTimes::None;
        EXPECT_TRUE(import(folder / "a.bag", none).scans[20].already_undistorted);
    }
}

TEST(ALivoxBag, OfCustomMessagesGivesTheirPoints)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(12);
    for (const auto wire : {TestWire::Ros1, TestWire::Cdr})
        for (const std::string type :
             {"livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg",
              "livox_interfaces/CustomMsg"})
        {
            TestMessages messages;
            for (const Scan& scan : scans)
                messages.push_back(
                    {"/livox/lidar", type, arrivalOf(scan), livoxMessage(scan, wire)});
            writeFile(
                folder / "a",
                wire == TestWire::Ros1 ? Ros1Writer::bag(messages) : McapWriter::file(messages));
            const Imported result = import(folder / "a");
            expectSame(result.scans, scans, 0);
            EXPECT_THAT(result.findings, HasSubstr("its start"));
        }
}

TEST(ALivoxBag, WhoseTimebaseIsSinceTheStartOfTheSensorKeepsTheStamps)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(12);
    TestMessages messages;
    for (const Scan& scan : scans)
        messages.push_back(
            {"/livox/lidar", "livox_ros_driver2/CustomMsg", arrivalOf(scan),
             livoxMessage(scan, TestWire::Ros1, -1'699'999'000'000'000'000)});
    writeFile(folder / "a.bag", Ros1Writer::bag(messages));
    expectSame(import(folder / "a.bag").scans, scans, 0);
}
}  // namespace
}  // namespace taut::test
