/** Packets of Velodyne and Hesai in bags of every kind. */
#include "bag_support.h"
#include "hesai_packets.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

const std::string kPackets = "/front/packets";

/** Payloads of a sensor and when they were taken. */
using Payloads = std::vector<std::pair<Time, Blob>>;

/** Two turns of an XT32 and a bit, by a clock that is right. */
Payloads hesaiPayloads(Duration clock_behind = 0)
{
    Payloads payloads;
    Time t = HesaiPacket::kSecond * 1'000'000'000 + clock_behind;
    for (const auto& packet : xt32Packets(510))
    {
        payloads.emplace_back(t + 1'000'000, packet);
        t += 400'000;
    }
    return payloads;
}

/** One turn of a VLP-32C at 10 Hz, from azimuth 0 on, that sees 10 m all around. */
Payloads velodynePayloads(velodyne::Model model = velodyne::Model::Vlp32)
{
    Payloads payloads;
    const double period = velodyne::firingPattern(model).blockPeriod();
    for (int i = 0; i < 160; i++)
    {
        Blob packet(velodyne::kPacketBytes);
        const double begin = 12 * period * i;  // [ns]
        for (std::size_t block = 0; block < 12; block++)
        {
            const auto azimuth = static_cast<std::uint16_t>(
                std::lround(360e-6 * (begin + period * static_cast<double>(block))) % 36000);
            packet[100 * block] = 0xff;
            packet[100 * block + 1] = 0xee;
            std::memcpy(&packet[100 * block + 2], &azimuth, 2);
            for (std::size_t slot = 0; slot < 32; slot++)
                packet[100 * block + 5 + 3 * slot] = 10;  // 2560 units
        }
        const auto us = static_cast<std::uint32_t>(
            kBagStart / 1000 % 3'600'000'000 + std::llround(begin / 1000));
        std::memcpy(&packet[1200], &us, 4);
        packet[1204] = 0x37;
        packet[1205] = static_cast<std::uint8_t>(model);
        payloads.emplace_back(kBagStart + std::llround(begin) + 1'000'000, packet);
    }
    return payloads;
}

/** Some packets in each message of a type. */
class PacketMessages
{
 public:
    std::string type;
    TestWire wire = TestWire::Cdr;
    std::uint32_t extra_size = 0;   //!< more than a packet says to have
    std::uint32_t extra_count = 0;  //!< more packets than a message says to have

    TestMessages of(const Payloads& payloads, std::size_t per_message = 100) const
    {
        TestMessages messages;
        for (std::size_t i = 0; i < payloads.size(); i += per_message)
        {
            const auto end = std::min(i + per_message, payloads.size());
            WireWriter out(wire);
            out.header(payloads[i].first);
            out.number(static_cast<std::uint32_t>(end - i) + extra_count);
            for (std::size_t k = i; k < end; k++) add(out, payloads[k]);
            messages.push_back({kPackets, type, payloads[end - 1].first, out.message()});
        }
        return messages;
    }

 private:
    void add(WireWriter& out, const std::pair<Time, Blob>& payload) const
    {
        out.number(static_cast<std::uint32_t>(payload.first / 1'000'000'000));
        out.number(static_cast<std::uint32_t>(payload.first % 1'000'000'000));
        const Blob& bytes = payload.second;
        if (type == "nebula_msgs/NebulaPackets") return out.bytes(bytes);
        for (const std::uint8_t byte : bytes) out.number(byte);
        if (type != "pandar_msgs/PandarScan") return;
        for (std::size_t i = bytes.size(); i < 1500; i++) out.number(std::uint8_t{0xEE});
        out.number(static_cast<std::uint32_t>(bytes.size()) + extra_size);
    }
};

class APacketBagOf : public testing::Test
{
 protected:
    std::string write(const TestMessages& messages, const std::string& kind = "mcap") const
    {
        const std::string path = folder_ / "a." + kind;
        if (kind == "db3") std::filesystem::remove(path), writeSqlite3Bag(path, messages);
        if (kind == "mcap") writeFile(path, McapWriter::file(messages));
        if (kind == "bag") writeFile(path, Ros1Writer::bag(messages));
        return path;
    }

    /** The same through every container and wire. */
    std::vector<Imported> throughAll(const std::string& type, const Payloads& payloads) const
    {
        std::vector<Imported> all;
        for (const std::string kind : {"mcap", "db3", "bag"})
        {
            PacketMessages messages{type};
            if (kind == "bag") messages.wire = TestWire::Ros1;
            all.push_back(import(write(messages.of(payloads), kind)));
        }
        return all;
    }

    TemporaryFolder folder_;
};

TEST_F(APacketBagOf, AHesaiComesBackFromEveryKind)
{
    const Time first = HesaiPacket::kSecond * 1'000'000'000 + 5632 - 7 * 50'000 + 368;
    for (const std::string type : {"pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets"})
        for (const Imported& all : throughAll(type, hesaiPayloads()))
        {
            ASSERT_EQ(all.scans.size(), 3U);
            EXPECT_EQ(all.scans[1].points.size(), 2000U * 32);
            EXPECT_EQ(all.scans[1].stamp, first + 100'000'000);
            EXPECT_EQ(all.warnings.counts().size(), 1U);
            EXPECT_EQ(all.warnings.count("no_imu"), 1U);
        }
}

TEST_F(APacketBagOf, AVelodyneComesBackFromEveryKind)
{
    for (const std::string type : {"velodyne_msgs/VelodyneScan", "nebula_msgs/NebulaPackets"})
        for (const Imported& all : throughAll(type, velodynePayloads()))
        {
            ASSERT_EQ(all.scans.size(), 2U);
            EXPECT_NEAR(static_cast<double>(all.scans[0].points.size()), 32 * 1808.4, 33);
            EXPECT_EQ(all.scans[0].points.size() + all.scans[1].points.size(), 160U * 12 * 32);
            EXPECT_LT(std::abs(all.scans[0].stamp - kBagStart), 1000);
            EXPECT_NEAR(all.scans[0].points[0].position.norm(), 10.24, 1e-5);
        }
}

TEST_F(APacketBagOf, AVlp16BecomesPointsToo)
{
    const PacketMessages messages{"velodyne_msgs/VelodyneScan"};
    const Imported all = import(write(messages.of(velodynePayloads(velodyne::Model::Vlp16))));
    ASSERT_EQ(all.scans.size(), 3U);  // 160 packets of 1.327 ms
    EXPECT_EQ(all.scans[0].rings, 16);
    // Cut at a block, not at a packet: a turn has 904.2 blocks of 32 returns.
    EXPECT_NEAR(static_cast<double>(all.scans[1].points.size()), 32 * 904.2, 33);
}

TEST_F(APacketBagOf, ASensorWithAnotherClockHasTheStampsOfTheRecorder)
{
    const PacketMessages messages{"pandar_msgs/PandarScan"};
    const Duration behind = 3'600'000'000'000;
    const std::string path = write(messages.of(hesaiPayloads(behind)));
    const Imported all = import(path);
    ASSERT_EQ(all.scans.size(), 3U);
    const Time taken = HesaiPacket::kSecond * 1'000'000'000 + behind;
    EXPECT_LT(std::abs(all.scans[0].stamp - taken), 2'000'000);
    EXPECT_THAT(all.findings, HasSubstr("the sensor's clock is 3600.0"));
    ImportOptions options;
    options.capture_clock = true;
    EXPECT_EQ(import(path, options).scans[1].stamp, all.scans[1].stamp);
}

TEST_F(APacketBagOf, ReadingsAreThoseOfTheImu)
{
    const PacketMessages messages{"velodyne_msgs/VelodyneScan"};
    const Imported all = import(write(merged(
        messages.of(velodynePayloads()), readingMessages(syntheticReadings(1), TestWire::Cdr))));
    EXPECT_EQ(all.readings.size(), 10U);
    EXPECT_EQ(all.scans.size(), 2U);
    EXPECT_TRUE(all.warnings.counts().empty());
}

TEST_F(APacketBagOf, ASensorThatHasCloudsTooGivesItsClouds)
{
    const PacketMessages messages{"velodyne_msgs/VelodyneScan"};
    const std::string path = write(merged(
        messages.of(velodynePayloads()), sweepMessages(syntheticSweeps(1), {}, TestWire::Cdr)));
    EXPECT_THAT(import(path).findings, HasSubstr(kLidarTopic));
    ImportOptions options;
    options.lidar_topic = "/front/.*";
    EXPECT_THAT(import(path, options).findings, HasSubstr(kPackets));
}

TEST_F(APacketBagOf, PacketsThatAreLongerThanTheirFieldFails)
{
    PacketMessages messages{"pandar_msgs/PandarScan"};
    messages.extra_size = 421;
    EXPECT_THAT(
        failure(write(messages.of(hesaiPayloads()))), HasSubstr("1501 bytes in a field of 1500"));
    messages.extra_size = 0xFFFFFFFF - 1080;
    EXPECT_THAT(failure(write(messages.of(hesaiPayloads()))), HasSubstr("in a field of 1500"));
    messages.extra_size = 7;
    EXPECT_THAT(
        failure(write(messages.of(hesaiPayloads()))), HasSubstr("1087 bytes instead of 1080"));
}

TEST_F(APacketBagOf, MessagesThatCountTooManyPacketsFails)
{
    for (const std::string type :
         {"velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets"})
        for (const std::uint32_t extra : {1U, 1'000'000U, 0xFFFFFF00U})
        {
            PacketMessages messages{type};
            messages.extra_count = extra;
            EXPECT_THAT(failure(write(messages.of(velodynePayloads()))), HasSubstr("ends early"))
                << type;
        }
}

TEST_F(APacketBagOf, DamageLosesThePacketsThatAreDamaged)
{
    auto payloads = hesaiPayloads();
    payloads[250].second.resize(700);
    payloads[251].second[2] = 9;
    payloads[252].second.clear();
    const PacketMessages messages{"nebula_msgs/NebulaPackets"};
    auto damaged = messages.of(payloads);
    damaged[4].data.resize(3000);
    const Imported all = import(write(damaged));
    ASSERT_EQ(all.scans.size(), 3U);
    EXPECT_EQ(all.warnings.count("packet_invalid"), 3U);
    EXPECT_EQ(all.warnings.count("message_invalid"), 1U);
    EXPECT_EQ(all.scans[0].points.size(), 250U * 8 * 32);
    EXPECT_EQ(all.scans[1].points.size(), 147U * 8 * 32);
}

TEST_F(APacketBagOf, RandomBytesNeverCrash)
{
    Random random(5);
    auto hesai = hesaiPayloads(), velodyne = velodynePayloads();
    hesai.resize(40);
    velodyne.resize(40);
    int read = 0;
    for (int i = 0; i < 200; i++)
    {
        const PacketMessages messages{
            i % 2 == 0 ? "nebula_msgs/NebulaPackets" : "pandar_msgs/PandarScan"};
        auto damaged = messages.of(i % 3 == 0 ? velodyne : hesai, 5);
        for (TestMessage& message : damaged)
            for (int k = 0; k < 5; k++)
            {
                const auto size = static_cast<double>(message.data.size());
                const auto at = static_cast<std::size_t>(random.uniform(0, size - 1));
                message.data[at] = static_cast<std::uint8_t>(random.uniform(0, 256));
            }
        try
        {
            for (const Scan& scan : import(write(damaged)).scans)
                for (const LidarPoint& point : scan.points)
                    ASSERT_TRUE(point.position.allFinite() && point.offset >= 0);
            read++;
        }
        catch (const std::runtime_error&)  // no usable packet left
        {
        }
    }
    EXPECT_GT(read, 50);
}

TEST_F(APacketBagOf, AnUnknownSensorFails)
{
    auto payloads = hesaiPayloads();
    for (auto& payload : payloads) payload.second[2] = 9;
    const PacketMessages messages{"nebula_msgs/NebulaPackets"};
    EXPECT_THAT(failure(write(messages.of(payloads))), HasSubstr("protocol 9.1"));
}

TEST_F(APacketBagOf, ACorrectionFileOfAnotherSensorFails)
{
    const PacketMessages messages{"pandar_msgs/PandarScan"};
    const std::string path = write(messages.of(hesaiPayloads()));
    std::ofstream(folder_ / "a.csv") << "Channel,Elevation,Azimuth\n1,0,0\n";
    EXPECT_THAT(failure(path), HasSubstr("it has 1 lasers, a PandarXT has 32"));
}
}  // namespace
}  // namespace taut::test
