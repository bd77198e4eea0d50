/** Which topics are read, and in which units an IMU is. */
#include "bag_support.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

class ABag : public testing::Test
{
 protected:
    TestMessages sweeps(const std::string& topic = kLidarTopic) const
    {
        auto messages = sweepMessages(scans_, {}, TestWire::Cdr);
        for (auto& m : messages) m.topic = topic;
        return messages;
    }
    std::string write(const TestMessages& messages) const
    {
        writeFile(folder_ / "a.mcap", McapWriter::file(messages));
        return folder_ / "a.mcap";
    }
    static TestMessages readings(const ImuSamples& samples)
    {
        return readingMessages(samples, TestWire::Cdr);
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_ = syntheticSweeps(12);
};

TEST_F(ABag, OfSeveralLidarsListsThemAndIsReadOnceOneIsChosen)
{
    const std::string path = write(merged(sweeps("/front/points"), sweeps("/rear/points")));
    EXPECT_THAT(
        failure(path),
        testing::AllOf(
            HasSubstr("/front/points (sensor_msgs/PointCloud2)"), HasSubstr("/rear/points"),
            HasSubstr("; choose one with --lidar-topic /front/points")));
    ImportOptions options;
    options.lidar_topic = "/re.*";
    expectSame(import(path, options).scans, scans_, 0);
    options.lidar_topic = "/r";  // the whole name must match
    EXPECT_THAT(failure(path, options), HasSubstr("--lidar-topic '/r' is no topic"));
    options.lidar_topic = "[";
    EXPECT_THAT(failure(path, options), HasSubstr("is not a regular expression"));
}

TEST_F(ABag, OfSeveralImusListsThem)
{
    auto others = readings(syntheticReadings(12));
    for (auto& m : others) m.topic = "/camera/imu";
    const std::string path =
        write(merged(merged(sweeps(), others), readings(syntheticReadings(12))));
    EXPECT_THAT(failure(path), HasSubstr("; choose one with --imu-topic /camera/imu"));
    ImportOptions options;
    options.imu_topic = kImuTopic;
    EXPECT_EQ(import(path, options).readings.size(), 120u);
}

TEST_F(ABag, WithoutALidarListsItsTopics)
{
    EXPECT_THAT(
        failure(write(readings(syntheticReadings(3)))),
        testing::AllOf(
            HasSubstr("no topic of a LiDAR"), HasSubstr("/ouster/imu (sensor_msgs/Imu)")));
}

TEST_F(ABag, OfUnknownMessagesFails)
{
    auto messages = sweeps();
    for (auto& m : messages) m.type = "radar_msgs/RadarScan";
    EXPECT_THAT(failure(write(messages)), HasSubstr("radar_msgs/RadarScan"));
}

TEST_F(ABag, WithoutAnImuSaysSo)
{
    const Imported result = import(write(sweeps()));
    EXPECT_EQ(result.scans.size(), scans_.size());
    EXPECT_EQ(result.warnings.count("no_imu"), 1u);
}

TEST_F(ABag, WhoseImuHasNoMessagesSaysSo)
{
    auto messages = merged(sweeps(), readings({syntheticReadings(1)[0]}));
    for (auto& m : messages)
        if (m.topic == kImuTopic) m.data.resize(20);  // the only one is broken
    const Imported result = import(write(messages));
    EXPECT_EQ(result.scans.size(), scans_.size());
    EXPECT_EQ(result.warnings.count("no_imu"), 1u);
}

TEST_F(ABag, WithoutASingleUsableSweepFails)
{
    auto messages = sweeps();
    for (auto& m : messages) m.data.resize(m.data.size() - 100);
    EXPECT_THAT(failure(write(messages)), HasSubstr("no sweep of /ouster/points can be used"));
}

TEST_F(ABag, WithSpecificForceInGOrMilliGIsConverted)
{
    for (const double unit : {1.0, 1000.0})
    {
        const auto written = syntheticReadings(12, unit);
        const Imported result = import(write(merged(sweeps(), readings(written))));
        ASSERT_EQ(result.readings.size(), written.size());
        for (std::size_t i = 0; i < written.size(); i++)
            EXPECT_TRUE(
                result.readings[i].accel.isApprox(written[i].accel * 9.80665 / unit, 1e-12));
        EXPECT_THAT(result.findings, HasSubstr(unit == 1 ? "in g" : "in milli-g"));
        EXPECT_THAT(result.findings, HasSubstr("converted"));
        EXPECT_EQ(result.warnings.count("imu_units"), 0u);
    }
}

TEST_F(ABag, WithValuesOfNoUnitKeepsThemAndWarns)
{
    auto written = syntheticReadings(12, 0.0001);
    written[3].gyro.x() = 200;
    const Imported result = import(write(merged(sweeps(), readings(written))));
    EXPECT_EQ(result.readings[5].accel, written[5].accel);
    EXPECT_EQ(result.warnings.count("imu_units"), 2u);
}

TEST_F(ABag, LeavesOutReadingsThatCannotBeUsed)
{
    auto written = syntheticReadings(12);
    written[20].t = written[19].t;
    written[30].accel.x() = std::numeric_limits<double>::quiet_NaN();
    written[40].t = 0;
    const Imported result = import(write(merged(sweeps(), readings(written))));
    EXPECT_EQ(result.readings.size(), written.size() - 3);
    for (const char* kind : {"imu_time", "imu_invalid", "no_stamp"})
        EXPECT_EQ(result.warnings.count(kind), 1u) << kind;
}
}  // namespace
}  // namespace taut::test
