#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "PcapWriter.h"
#include "import_support.h"
#include "temporary_folder.h"
#include "velodyne_bytes.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;
using velodyne::Model;

/** Packets of whole firing sequences of a head that turns at 10 Hz; azimuth 0 at `begin`. */
std::vector<velodyne::Packet> packets(Model model, Time begin, int count)
{
    velodyne::PacketWriter writer(model);
    const auto& pattern = velodyne::firingPattern(model);
    std::vector<velodyne::Packet> all;
    for (int i = 0; static_cast<int>(all.size()) < count; i++)
    {
        const auto since = std::llround(i * pattern.sequence_period);
        std::vector<velodyne::Cell> cells(static_cast<std::size_t>(pattern.lasers));
        for (auto& cell : cells) cell = {5 + 1e-3 * i, static_cast<std::uint8_t>(i)};
        writer.add(begin + since, std::fmod(3600 * toSeconds(since), 360), cells);
        for (const auto& packet : writer.take()) all.push_back(packet);
    }
    return all;
}

class AVelodyneCapture : public testing::Test
{
 protected:
    void write(const std::vector<velodyne::Packet>& all, Duration device_ahead = 0)
    {
        PcapWriter pcap(path_);
        velodyne::PacketClock clock;
        for (const auto& packet : all)
        {
            const Duration since =
                clock.sinceFirst(velodyne::packetInfo(packet.data()).microseconds);
            pcap.write(kStart + since - device_ahead + kPacket, 2368, packet);
        }
    }

    static constexpr Duration kPacket = 1'327'104;
    TemporaryFolder folder_;
    const std::string path_ = folder_ / "a.pcap";
};

TEST_F(AVelodyneCapture, IsCutWhereTheAzimuthWrapsAndKeepsEveryPacket)
{
    for (const Model model : {Model::Vlp16, Model::Hdl32})
    {
        const auto sent = packets(model, kStart, 460);
        write(sent);
        const Imported all = importAll(path_);
        EXPECT_EQ(all.failure, "");
        EXPECT_EQ(all.packet_scans.size(), model == Model::Vlp16 ? 7U : 3U);
        std::vector<velodyne::Packet> received;
        for (const PacketScan& scan : all.packet_scans)
        {
            for (std::size_t i = 1; i < scan.packets.size(); i++)
                EXPECT_GT(
                    velodyne::blockAzimuth(scan.packets[i].data(), 0),
                    velodyne::blockAzimuth(scan.packets[i - 1].data(), 0));
            received.insert(received.end(), scan.packets.begin(), scan.packets.end());
        }
        EXPECT_TRUE(received == sent);
        EXPECT_EQ(all.warnings.counts().size(), 0U);
    }
}

TEST_F(AVelodyneCapture, OfPacketsThatCameTwiceOrSwappedHasTheSameSweeps)
{
    for (const Model model : {Model::Vlp16, Model::Hdl32})
    {
        const auto sent = packets(model, kStart, 300);
        write(sent);
        const Imported right = importAll(path_);
        auto twice = sent;
        for (std::size_t i = 1; i < twice.size(); i += 3) std::swap(twice[i - 1], twice[i]);
        for (std::size_t i = twice.size(); i-- > 0;)
            twice.insert(twice.begin() + static_cast<std::ptrdiff_t>(i), twice[i]);
        write(twice);
        const Imported all = importAll(path_);
        ASSERT_EQ(all.packet_scans.size(), right.packet_scans.size());
        std::size_t packets_read = 0;
        for (std::size_t k = 0; k < right.packet_scans.size(); k++)
        {
            packets_read += all.packet_scans[k].packets.size();
            EXPECT_NEAR(
                static_cast<double>(all.packet_scans[k].packets.size()),
                static_cast<double>(right.packet_scans[k].packets.size()), 2);
        }
        EXPECT_EQ(packets_read, sent.size());
        EXPECT_THAT(all.findings, testing::Contains(HasSubstr("300 packets came twice")));
        EXPECT_EQ(all.warnings.counts().size(), 0U);
    }
}

/** A pcap file of one packet over Ethernet, byte by byte, captured at 1700000001.5 s. */
std::string capturedByHand()
{
    const auto packet = knownPacket();
    std::string file;
    const auto put = [&file](std::initializer_list<int> bytes)
    {
        for (const int byte : bytes) file.push_back(static_cast<char>(byte));
    };
    put({0xd4, 0xc3, 0xb2, 0xa1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0, 0, 1, 0, 0, 0});
    put({0x01, 0xf1, 0x53, 0x65, 0x20, 0xa1, 0x07, 0});  // 1700000001 s, 500000 us
    put({0xe0, 0x04, 0, 0, 0xe0, 0x04, 0, 0});           // 1248 bytes
    put({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x60, 0x76, 0x88, 0, 0, 1, 8, 0});
    put({0x45, 0, 0x04, 0xd2, 0, 1, 0x40, 0, 0xff, 17, 0, 0});  // IPv4, 1234 bytes, UDP
    put({192, 168, 1, 201, 255, 255, 255, 255});
    put({0x09, 0x40, 0x09, 0x40, 0x04, 0xbe, 0, 0});  // port 2368, 1214 bytes
    return file.append(packet.begin(), packet.end());
}

TEST_F(AVelodyneCapture, WrittenByHandHasItsStampAndItsReturns)
{
    std::ofstream(path_, std::ios::binary) << capturedByHand();
    const Imported all = importAll(path_);
    ASSERT_EQ(all.failure, "");
    ASSERT_EQ(all.packet_scans.size(), 1U);
    const PacketScan& scan = all.packet_scans[0];
    ASSERT_EQ(scan.packets.size(), 1U);
    EXPECT_EQ(scan.stamp, kStart + 1000 * kMillisecond);  // 13 min 21 s after 22:00 UTC
    std::vector<velodyne::Return> returns;
    velodyne::decodePacket(
        scan.packets[0].data(), velodyne::defaultCalibration(Model::Vlp16), returns);
    ASSERT_EQ(returns.size(), kKnownReturns.size());
    for (std::size_t i = 0; i < returns.size(); i++)
    {
        const KnownReturn& known = kKnownReturns[i];
        const Vector3d position(known.x, known.y, known.z);
        EXPECT_LT((returns[i].position.cast<double>() - position).norm(), 2e-5);
        EXPECT_EQ(returns[i].intensity, known.intensity);
    }
}

TEST_F(AVelodyneCapture, IsStampedByTheSensorInTheHourOfTheCaptureOrByTheCapture)
{
    const Time hour = kStart / 3'600'000'000'000 * 3'600'000'000'000;
    const Time begin = hour + 3'599'950 * kMillisecond;  // runs over the full hour
    const auto sent = packets(Model::Vlp16, begin, 200);
    {
        PcapWriter pcap(path_);
        for (std::size_t i = 0; i < sent.size(); i++)
            pcap.write(
                begin + (static_cast<Time>(i) + 1) * kPacket + 80 * kMillisecond, 2368, sent[i]);
    }
    const Imported all = importAll(path_);
    ASSERT_EQ(all.packet_scans.size(), 3U);
    EXPECT_EQ(all.packet_scans[0].stamp, begin);
    EXPECT_NEAR(toSeconds(all.packet_scans[2].stamp - begin), 0.2, 0.0014);

    ImportOptions options;
    options.capture_clock = true;
    const Imported by_capture = importAll(path_, options);
    ASSERT_EQ(by_capture.packet_scans.size(), 3U);
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(
            toSeconds(by_capture.packet_scans[i].stamp - all.packet_scans[i].stamp), 0.080, 2e-6);
}

TEST_F(AVelodyneCapture, IsReadFromEveryLink)
{
    const auto sent = packets(Model::Vlp16, kStart, 90);
    for (const int link : {DLT_EN10MB, DLT_RAW, DLT_NULL, DLT_LINUX_SLL, DLT_LINUX_SLL2})
    {
        {
            PcapWriter pcap(path_, link);
            for (const auto& packet : sent) pcap.write(kStart, 2368, packet);
        }
        EXPECT_EQ(importAll(path_).packet_scans.size(), 2U) << link;
    }
    {
        PcapWriter pcap(path_, DLT_IEEE802_11);
    }
    EXPECT_THAT(importAll(path_).failure, HasSubstr("from a link that is not known here"));
}

TEST_F(AVelodyneCapture, OfDualReturnsIsCutAndCountedLikewise)
{
    // Pairs of blocks share their azimuth; a packet holds half the time.
    auto sent = packets(Model::Vlp16, kStart, 160);
    for (std::size_t i = 0; i < sent.size(); i++)
    {
        sent[i][velodyne::kPacketBytes - 2] = 0x39;
        for (std::size_t block = 0; block < 12; block++)
        {
            const auto azimuth = (i * 240 + block / 2 * 40) % 36000;
            sent[i][block * 100 + 2] = static_cast<std::uint8_t>(azimuth & 255);
            sent[i][block * 100 + 3] = static_cast<std::uint8_t>(azimuth >> 8);
        }
        const auto microseconds = static_cast<std::uint32_t>(i * 663552 / 1000);
        for (std::size_t k = 0; k < 4; k++)
            sent[i][1200 + k] = static_cast<std::uint8_t>(microseconds >> (8 * k) & 255);
    }
    write(sent);
    const Imported all = importAll(path_);
    EXPECT_EQ(all.packet_scans.size(), 2U);
    EXPECT_THAT(all.findings, testing::Contains(HasSubstr("dual return: 160 packets")));
    EXPECT_THAT(all.findings, testing::Not(testing::Contains(HasSubstr("missing"))));
}

TEST_F(AVelodyneCapture, OfTwoSensorsKeepsTheFirstAndSaysSo)
{
    const auto sent = packets(Model::Vlp16, kStart, 160);
    {
        PcapWriter pcap(path_);
        for (const auto& packet : sent)
        {
            pcap.from = 0xc0a801c9;
            pcap.write(kStart, 2368, packet);
            pcap.from++;
            pcap.write(kStart, 2368, packet);
        }
    }
    const Imported all = importAll(path_);
    std::size_t received = 0;
    for (const auto& scan : all.packet_scans) received += scan.packets.size();
    EXPECT_EQ(received, sent.size());
    ASSERT_EQ(all.warnings.count("second_sensor"), 1U);
    EXPECT_THAT(all.warnings.kept()[0].text, HasSubstr("192.168.1.202"));
}

TEST_F(AVelodyneCapture, CutOffGivesWhatIsThereAndSaysSo)
{
    write(packets(Model::Vlp16, kStart, 160));
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 700);
    const Imported all = importAll(path_);
    EXPECT_EQ(all.packet_scans.size(), 3U);
    EXPECT_EQ(all.warnings.count("pcap_truncated"), 1U);
}

TEST_F(AVelodyneCapture, WithASnapLengthIsNoCaptureOfASensor)
{
    {
        PcapWriter pcap(path_);
        pcap.snap_length = 96;
        for (const auto& packet : packets(Model::Vlp16, kStart, 3))
            pcap.write(kStart, 2368, packet);
    }
    EXPECT_THAT(importAll(path_).failure, HasSubstr("no packet of a known sensor"));
}

TEST_F(AVelodyneCapture, OfAnUnknownModelIsNamed)
{
    auto sent = packets(Model::Vlp16, kStart, 3);
    for (auto& packet : sent) packet[velodyne::kPacketBytes - 1] = 0x24;
    {
        PcapWriter pcap(path_);
        for (const auto& packet : sent) pcap.write(kStart, 2368, packet);
    }
    EXPECT_THAT(importAll(path_).failure, HasSubstr("model 0x24"));
}

TEST_F(AVelodyneCapture, KeepsItsGoodPacketsWhereOneIsDamaged)
{
    auto sent = packets(Model::Vlp16, kStart, 160);
    sent[50][300] = 0;  // flag of a block
    write(sent);
    const Imported all = importAll(path_);
    std::size_t received = 0;
    for (const auto& scan : all.packet_scans) received += scan.packets.size();
    EXPECT_EQ(received, sent.size() - 1);
    EXPECT_EQ(all.warnings.count("packet_invalid"), 1U);
}

TEST_F(AVelodyneCapture, ThatLostPacketsSaysHowMany)
{
    auto sent = packets(Model::Vlp16, kStart, 160);
    sent.erase(sent.begin() + 40, sent.begin() + 43);
    write(sent);
    const Imported all = importAll(path_);
    EXPECT_THAT(all.findings, testing::Contains(HasSubstr("3 packets are missing")));
}

TEST_F(AVelodyneCapture, WithoutAnyPacketIsNamed)
{
    {
        PcapWriter pcap(path_);
    }
    EXPECT_THAT(importAll(path_).failure, HasSubstr("0 records"));
    std::filesystem::resize_file(path_, 10);
    EXPECT_THAT(importAll(path_).failure, HasSubstr("cannot read the capture"));
}
}  // namespace
}  // namespace taut::test
