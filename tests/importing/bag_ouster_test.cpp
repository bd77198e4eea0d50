/** Packets of an Ouster in bags of every kind. */
#include "OusterSimulator.h"
#include "bag_support.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

class AnOusterBag : public testing::Test
{
 protected:
    static constexpr int kFrames = 3;
    const std::string lidar_topic_ = "/os/lidar_packets", imu_topic_ = "/os/imu_packets";
    const std::string package_ = "ouster_sensor_msgs";

    TestMessage packet(const std::string& topic, Time device, const Blob& payload) const
    {
        WireWriter out(wire_);
        out.bytes(payload);
        const Time received = kBagStart + device - sensor_.device_start + 1'000'000;
        return {topic, package_ + "/PacketMsg", received, out.message()};
    }

    TestMessage metadata(const std::string& text, const std::string& topic = "/os/metadata") const
    {
        WireWriter out(wire_);
        out.text(text);
        return {topic, "std_msgs/String", kBagStart, out.message()};
    }

    TestMessages packets() const
    {
        TestMessages messages;
        for (int frame = 0; frame < kFrames; frame++)
            for (int i = 0; i < sensor_.packetsPerFrame(); i++)
                messages.push_back(packet(
                    lidar_topic_,
                    sensor_.columnTime(frame, (i + 1) * sensor_.columns_per_packet - 1),
                    sensor_.packet(frame, i)));
        return messages;
    }

    TestMessages readings() const
    {
        TestMessages messages;
        for (int i = 0; i < 30; i++)
        {
            const Time t = sensor_.device_start + i * 10'000'000;
            messages.push_back(packet(
                imu_topic_, t,
                OusterSimulator::imuPacket({t, {0.1, 0.2, 0.3 + 0.001 * i}, {0, 0, 9.80665}})));
        }
        return messages;
    }

    TestMessages all() const
    {
        TestMessages messages = merged(packets(), readings());
        messages.insert(messages.begin(), metadata(sensor_.description().dump()));
        return messages;
    }

    /** Every point, and its time by the sensor's clock, put on the calendar by whole seconds. */
    void expectComplete(const Imported& got)
    {
        ASSERT_EQ(got.scans.size(), std::size_t{kFrames});
        const Duration shift = got.scans[0].stamp - sensor_.device_start;
        EXPECT_EQ(shift % 1'000'000'000, 0);
        EXPECT_LT(std::abs(got.scans[0].stamp - kBagStart), 1'000'000'000);
        for (int frame = 0; frame < kFrames; frame++)
        {
            auto point = got.scans[frame].points.begin();
            for (int column = 0; column < sensor_.columns; column++)
                for (int pixel = 0; pixel < sensor_.pixels; pixel++)
                {
                    if (sensor_.range_mm(frame, column, pixel) == 0) continue;
                    ASSERT_NE(point, got.scans[frame].points.end());
                    const Vector3d expected = sensor_.point(frame, column, pixel);
                    EXPECT_LT((point->position.cast<double>() - expected).norm(), 1e-4);
                    EXPECT_EQ(
                        got.scans[frame].timeOf(*point) - shift, sensor_.columnTime(frame, column));
                    ++point;
                }
            EXPECT_EQ(point, got.scans[frame].points.end());
        }
        ASSERT_EQ(got.readings.size(), 30U);
        EXPECT_EQ(got.readings[0].t - shift, sensor_.device_start);
        EXPECT_NEAR(got.readings[0].gyro.y(), 0.2, 1e-6);
    }

    std::string write(const TestMessages& messages) const
    {
        writeFile(folder_ / "a.mcap", McapWriter::file(messages));
        return folder_ / "a.mcap";
    }

    OusterSimulator sensor_;
    TestWire wire_ = TestWire::Cdr;
    TemporaryFolder folder_;
};

TEST_F(AnOusterBag, OfEveryKindComesBack)
{
    writeSqlite3Bag(folder_ / "a.db3", all());
    expectComplete(import(folder_ / "a.db3"));
    expectComplete(import(write(all())));
    wire_ = TestWire::Ros1;
    writeFile(folder_ / "a.bag", Ros1Writer::bag(all()));
    expectComplete(import(folder_ / "a.bag"));
}

TEST_F(AnOusterBag, HasPacketsWithTheByteThatOldDriversAppend)
{
    TestMessages messages{metadata(sensor_.description().dump())};
    auto longer = sensor_.packet(0, 0);
    longer.push_back(0);
    messages.push_back(packet(lidar_topic_, sensor_.device_start, longer));
    EXPECT_EQ(import(write(messages)).scans.size(), 1U);
}

TEST_F(AnOusterBag, TakesTheDescriptionOfItsOwnNamespaceWhereverItComes)
{
    TestMessages messages = all();
    messages.insert(messages.begin(), metadata("{}", "/a/metadata"));
    std::rotate(messages.begin(), messages.begin() + 2, messages.end());
    expectComplete(import(write(messages)));
}

TEST_F(AnOusterBag, WithoutADescriptionNeedsOne)
{
    const std::string path = write(merged(packets(), readings()));
    EXPECT_THAT(failure(path), HasSubstr("no description of the Ouster"));
    const std::string json = folder_ / "sensor.json";
    std::ofstream(json) << sensor_.description();
    ImportOptions options;
    options.ouster_json = json;
    expectComplete(import(path, options));
    std::filesystem::rename(json, folder_ / "a.json");
    expectComplete(import(path));
}

TEST_F(AnOusterBag, WithTheDescriptionOfAnotherSensorFails)
{
    auto description = sensor_.description();
    description["data_format"]["columns_per_packet"] = 8;
    TestMessages messages = packets();
    messages.push_back(metadata(description.dump()));
    EXPECT_THAT(failure(write(messages)), HasSubstr("bytes where the description says"));
    messages.back() = metadata("no JSON");
    EXPECT_THAT(failure(write(messages)), HasSubstr("/os/metadata does not describe an Ouster"));
}

TEST_F(AnOusterBag, WithASecondImuAsksWhich)
{
    const std::string path =
        write(merged(all(), readingMessages(syntheticReadings(3), TestWire::Cdr)));
    EXPECT_THAT(failure(path), HasSubstr("; choose one with --imu-topic /os/imu_packets"));
    ImportOptions options;
    options.imu_topic = kImuTopic;
    const Imported got = import(path, options);
    EXPECT_EQ(got.readings.size(), 30U);
    // The readings have the recorder's clock, and so have the sweeps then.
    EXPECT_LT(std::abs(got.scans[1].stamp - (kBagStart + 100'000'000)), 2'000'000);
}

TEST_F(AnOusterBag, LeavesOutPacketsThatAreNone)
{
    TestMessages messages = all();
    messages.push_back(packet(imu_topic_, sensor_.device_start, Blob(47)));
    messages.push_back(messages.back());
    messages.back().data.resize(9);
    const Imported got = import(write(messages));
    EXPECT_EQ(got.scans.size(), std::size_t{kFrames});
    EXPECT_EQ(got.warnings.count("packet_invalid"), 1U);
    EXPECT_EQ(got.warnings.count("message_invalid"), 1U);
}
}  // namespace
}  // namespace taut::test
