#include "taut/packets/velodyne/Decoder.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "pcap_support.h"
#include "rawlog_support.h"
#include "velodyne_bytes.h"

namespace taut::test
{
using namespace velodyne;

namespace
{
/** What the facts files count, by this decoder. */
struct Summary
{
    std::vector<std::size_t> per_revolution{0}, per_laser;
    std::size_t valid = 0;
    double mean_range = 0, mean_intensity = 0, min_range = 1e9, max_range = 0, turned = 0;
};

Summary summarize(const std::vector<PcapPacket>& packets)
{
    Summary s;
    int last_azimuth = -1;
    std::vector<Return> returns;
    for (const auto& packet : packets)
    {
        const auto* bytes = packet.bytes.data();
        const Model model = packetInfo(bytes).model;
        s.per_laser.resize(firingPattern(model).lasers);
        returns.clear();
        decodePacket(bytes, defaultCalibration(model), returns);
        auto next = returns.begin();
        for (int block = 0; block < kBlocks; block++)
        {
            const int azimuth = blockAzimuth(bytes, block);
            if (azimuth < last_azimuth) s.per_revolution.push_back(0);
            if (last_azimuth >= 0) s.turned += (azimuth - last_azimuth + 36000) % 36000 * 0.01;
            last_azimuth = azimuth;
            for (; next != returns.end() && next->block == block; ++next)
            {
                const double range = next->position.cast<double>().norm();
                s.valid++;
                s.per_revolution.back()++;
                s.per_laser[next->laser]++;
                s.mean_range += range;
                s.mean_intensity += next->intensity;
                s.min_range = std::min(s.min_range, range);
                s.max_range = std::max(s.max_range, range);
            }
        }
    }
    s.mean_range /= static_cast<double>(s.valid);
    s.mean_intensity /= static_cast<double>(s.valid);
    return s;
}

class VelodyneRecording : public testing::TestWithParam<const char*>
{
};
}  // namespace

TEST_P(VelodyneRecording, DecodesToTheFactsOfAnIndependentDecoder)
{
    const auto pcap = dataFolder() / "pcap" / (std::string(GetParam()) + ".pcap");
    const auto facts_file = dataFolder() / "pcap" / (std::string(GetParam()) + ".facts.json");
    if (!std::filesystem::exists(pcap)) return skipWithout(pcap.filename().string());
    const auto facts = nlohmann::json::parse(std::ifstream(facts_file));
    const auto packets = readVelodynePcap(pcap.string());
    ASSERT_EQ(packets.size(), facts["data_packets"]);

    const Summary s = summarize(packets);
    EXPECT_EQ(s.valid, facts["valid_returns_total"]);
    EXPECT_EQ(s.per_revolution, facts["valid_returns_per_revolution"]);
    EXPECT_EQ(s.per_laser, facts["valid_per_laser_id"]);
    EXPECT_NEAR(s.turned / 360, facts["revolutions"].get<double>(), 1e-4);
    EXPECT_NEAR(s.mean_range, facts["mean_range_m"].get<double>(), 1e-5);
    EXPECT_NEAR(s.min_range, facts["min_range_m"].get<double>(), 1e-5);
    EXPECT_NEAR(s.max_range, facts["max_range_m"].get<double>(), 1e-4);
    EXPECT_NEAR(s.mean_intensity, facts["intensity_mean"].get<double>(), 1e-9);

    PacketClock clock;
    Duration span = 0;
    for (const auto& packet : packets)
        span = clock.sinceFirst(packetInfo(packet.bytes.data()).microseconds);
    EXPECT_NEAR(toSeconds(span), facts["device_time_span_s"].get<double>(), 1e-9);
}

// The last firing of a packet is one period before the first one of the next packet; so are
// azimuths.
TEST_P(VelodyneRecording, TimesAndAzimuthsRunOnFromPacketToPacket)
{
    const auto pcap = dataFolder() / "pcap" / (std::string(GetParam()) + ".pcap");
    if (!std::filesystem::exists(pcap)) return skipWithout(pcap.filename().string());
    const auto packets = readVelodynePcap(pcap.string());
    const auto facts = nlohmann::json::parse(
        std::ifstream(dataFolder() / "pcap" / (std::string(GetParam()) + ".facts.json")));
    const double rate = facts["rotation_hz_device_clock"].get<double>() * 360e-9;  // [deg/ns]
    PacketClock clock;
    std::vector<Return> returns;
    double last_time = 0, last_azimuth = 0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < packets.size(); i++)
    {
        const auto* bytes = packets[i].bytes.data();
        const auto model = packetInfo(bytes).model;
        returns.clear();
        const auto info = decodePacket(bytes, defaultCalibration(model), returns);
        const double start = static_cast<double>(clock.sinceFirst(info.microseconds));
        if (returns.empty()) continue;
        const auto& pattern = firingPattern(model);
        const double time = start + returns.front().offset;
        if (i > 0 && time - last_time < 2 * pattern.sequence_period)
        {
            const double step = std::remainder(returns.front().azimuth - last_azimuth, 360);
            EXPECT_NEAR(step, rate * (time - last_time), 0.03);
            compared++;
        }
        last_time = start + returns.back().offset;
        last_azimuth = returns.back().azimuth;
    }
    EXPECT_GT(compared, packets.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, VelodyneRecording, testing::Values("vlp16_5hz", "vlp16_gps", "hdl32"),
    [](const auto& test) { return std::string(test.param); });

namespace
{
Packet onePacket(Model model, double azimuth_step, double range)
{
    PacketWriter writer(model);
    const auto& pattern = firingPattern(model);
    for (int i = 0; i < writer.sequencesPerPacket(); i++)
        writer.add(
            kStart + std::llround(i * pattern.sequence_period), 350 + i * azimuth_step,
            std::vector<Cell>(static_cast<std::size_t>(pattern.lasers), Cell{range, 7}));
    return writer.take().at(0);
}
}  // namespace

TEST(VelodyneDecoder, GivesWhatIsKnownOfAPacketWrittenByHand)
{
    const auto bytes = knownPacket();
    std::vector<Return> returns;
    const PacketInfo info =
        decodePacket(bytes.data(), defaultCalibration(packetInfo(bytes.data()).model), returns);
    EXPECT_EQ(info.model, Model::Vlp16);
    EXPECT_EQ(info.microseconds, 801'000'000U);
    ASSERT_EQ(returns.size(), kKnownReturns.size());
    for (std::size_t i = 0; i < returns.size(); i++)
    {
        const KnownReturn& known = kKnownReturns[i];
        EXPECT_EQ(returns[i].block, known.block);
        EXPECT_EQ(returns[i].laser, known.laser);
        EXPECT_EQ(returns[i].intensity, known.intensity);
        EXPECT_NEAR(returns[i].offset, known.offset, 1);
        EXPECT_NEAR(returns[i].azimuth, known.azimuth, 2e-5);
        EXPECT_NEAR(returns[i].position.x(), known.x, 1e-5);
        EXPECT_NEAR(returns[i].position.y(), known.y, 1e-5);
        EXPECT_NEAR(returns[i].position.z(), known.z, 1e-5);
    }
}

TEST(VelodyneDecoder, FollowsTheDataSheetOfTheVlp16)
{
    std::vector<Return> returns;
    decodePacket(
        onePacket(Model::Vlp16, 0.2, 10).data(), defaultCalibration(Model::Vlp16), returns);
    ASSERT_EQ(returns.size(), 384u);
    const Return& r = returns[3 * 32 + 16 + 5];  // block 3, second sequence, laser 5: 5 deg up
    EXPECT_EQ(r.laser, 5);
    EXPECT_EQ(r.block, 3);
    EXPECT_EQ(r.offset, 7 * 55296 + 5 * 2304);
    const double azimuth = 350 + 7 * 0.2 + 0.2 * 5 * 2304 / 55296;
    EXPECT_NEAR(r.azimuth, azimuth, 1e-4);
    const double a = azimuth * M_PI / 180, e = 5 * M_PI / 180;
    EXPECT_NEAR(r.position.x(), 10 * cos(e) * cos(a), 1e-4);
    EXPECT_NEAR(r.position.y(), -10 * cos(e) * sin(a), 1e-4);
    EXPECT_NEAR(r.position.z(), 10 * sin(e), 1e-4);
}

TEST(VelodyneDecoder, FollowsTheDataSheetOfTheHdl32)
{
    std::vector<Return> returns;
    decodePacket(
        onePacket(Model::Hdl32, 0.15, 20).data(), defaultCalibration(Model::Hdl32), returns);
    ASSERT_EQ(returns.size(), 384u);
    const Return& r = returns[11 * 32 + 31];
    EXPECT_EQ(r.laser, 31);
    EXPECT_EQ(r.offset, 11 * 46080 + 31 * 1152);
    EXPECT_NEAR(r.position.z(), 20 * std::sin(10.67 * M_PI / 180), 1e-4);
    EXPECT_NEAR(r.azimuth, 350 + 11 * 0.15 + 0.15 * 31 * 1152 / 46080, 1e-2);
}

TEST(VelodyneDecoder, InDualModeGivesBothReturnsOnceAndAtTheSameTime)
{
    Packet packet = onePacket(Model::Vlp16, 0, 10);
    packet[kPacketBytes - 2] = 0x39;
    for (int block = 0; block < kBlocks; block++)  // pairs turn together
    {
        const int azimuth = 1000 + block / 2 * 40;
        packet[block * 100 + 2] = static_cast<std::uint8_t>(azimuth & 255);
        packet[block * 100 + 3] = static_cast<std::uint8_t>(azimuth >> 8);
    }
    packet[3 * 100 + 4 + 3 * 2 + 1]++;  // laser 2 of block 3 has a second return, 0.512 m farther
    std::vector<Return> returns;
    decodePacket(packet.data(), defaultCalibration(Model::Vlp16), returns);
    ASSERT_EQ(returns.size(), 6u * 32 + 1);
    const auto& second = returns[4 * 16];
    EXPECT_EQ(second.block, 3);
    EXPECT_EQ(second.laser, 2);
    EXPECT_NEAR(second.position.norm(), 10.512, 1e-4);
    EXPECT_EQ(second.offset, 2 * 55296 + 2 * 2304);
    EXPECT_EQ(returns[2 * 16 + 2].offset, second.offset);
    EXPECT_EQ(returns[2 * 16 + 2].azimuth, second.azimuth);
    EXPECT_NEAR(returns[16].azimuth, 10.2, 1e-4);  // half a block on: the rate is that of the pairs
}

TEST(VelodyneDecoder, KeepsTheTurningRateWhereTheHeadLeapsOverASector)
{
    Packet packet = onePacket(Model::Vlp16, 0.2, 10);
    for (int block = 6; block < kBlocks; block++)
    {
        const int azimuth = 20000 + block * 40;
        packet[block * 100 + 2] = static_cast<std::uint8_t>(azimuth & 255);
        packet[block * 100 + 3] = static_cast<std::uint8_t>(azimuth >> 8);
    }
    std::vector<Return> returns;
    decodePacket(packet.data(), defaultCalibration(Model::Vlp16), returns);
    EXPECT_NEAR(returns[5 * 32 + 16].azimuth, 350 + 11 * 0.2, 1e-4);
}

TEST(VelodyneDecoder, AppliesACalibration)
{
    Calibration calibration = defaultCalibration(Model::Vlp16);
    calibration[0] = {0, 90 * M_PI / 180, 0.5, 0.03, 0.02};
    PacketWriter writer(Model::Vlp16);
    std::vector<Cell> cells(16);
    cells[0] = {10, 1};
    writer.add(kStart, 90, cells);
    std::vector<Return> returns;
    decodePacket(writer.take(true).at(0).data(), calibration, returns);
    ASSERT_EQ(returns.size(), 1u);
    EXPECT_NEAR((returns[0].position - Eigen::Vector3f(10.5f, 0.02f, 0.03f)).norm(), 0, 1e-5);
}

TEST(VelodyneDecoder, NamesWhatItCannotDecode)
{
    const auto message = [](Packet packet, const Calibration& calibration)
    {
        std::vector<Return> returns;
        try
        {
            decodePacket(packet.data(), calibration, returns);
        }
        catch (const std::runtime_error& e)
        {
            return std::string(e.what());
        }
        return std::string();
    };
    using testing::HasSubstr;
    const auto& calibration = defaultCalibration(Model::Vlp16);
    Packet packet = onePacket(Model::Vlp16, 0.2, 10);
    EXPECT_EQ(message(packet, calibration), "");
    EXPECT_THAT(
        message(packet, defaultCalibration(Model::Hdl32)), HasSubstr("32 lasers, the sensor 16"));
    packet[kPacketBytes - 1] = 0x24;
    EXPECT_THAT(message(packet, calibration), HasSubstr("model 0x24"));
    packet[kPacketBytes - 1] = 0x22;
    packet[kPacketBytes - 2] = 0;
    EXPECT_THAT(message(packet, calibration), HasSubstr("mode 0x00"));
    packet[kPacketBytes - 2] = 0x38;
    packet[300] = 0;
    EXPECT_THAT(message(packet, calibration), HasSubstr("0xee00"));
}

TEST(PacketClock, RunsOnOverTheFullHourAndBackOverPacketsOutOfOrder)
{
    PacketClock clock;
    EXPECT_EQ(clock.sinceFirst(3'599'999'000), 0);
    EXPECT_EQ(clock.sinceFirst(3'599'999'500), 500'000);
    EXPECT_EQ(clock.sinceFirst(500), 1'500'000);
    EXPECT_EQ(clock.sinceFirst(3'599'999'900), 900'000);
    EXPECT_EQ(clock.sinceFirst(1000), 2'000'000);
}

TEST(PacketWriter, IsTheInverseOfTheDecoderUpToTheResolution)
{
    for (const Model model : {Model::Vlp16, Model::Hdl32})
    {
        Random random(1);
        PacketWriter writer(model);
        const auto& pattern = firingPattern(model);
        struct Fired
        {
            double range, azimuth, time;
            int laser, intensity;
        };
        std::vector<Fired> fired;
        constexpr double kTurn = 3600e-9;  // deg/ns at 10 Hz
        for (int i = 0; i < 100; i++)
        {
            std::vector<Cell> cells(static_cast<std::size_t>(pattern.lasers));
            const double t = i * pattern.sequence_period;
            for (int laser = 0; laser < pattern.lasers; laser++)
            {
                if (random.uniform(0, 1) < 0.2) continue;
                cells[laser] = {random.uniform(0.3, 131), static_cast<std::uint8_t>(laser + i)};
                const double time = t + laser * pattern.laser_period;
                fired.push_back(
                    {cells[laser].range, std::fmod(359 + time * kTurn, 360), time, laser,
                     cells[laser].intensity});
            }
            writer.add(kStart + std::llround(t), 359 + t * kTurn, cells);
        }
        PacketClock clock;
        std::vector<Return> returns;
        std::size_t i = 0;
        for (const auto& packet : writer.take(true))
        {
            returns.clear();
            const auto info = decodePacket(packet.data(), defaultCalibration(model), returns);
            const Duration start = clock.sinceFirst(info.microseconds);
            for (const auto& r : returns)
            {
                ASSERT_LT(i, fired.size());
                EXPECT_EQ(r.laser, fired[i].laser);
                EXPECT_EQ(r.intensity, fired[i].intensity);
                EXPECT_NEAR(r.position.norm(), fired[i].range, 0.00101);
                EXPECT_NEAR(std::remainder(r.azimuth - fired[i].azimuth, 360), 0, 0.0101);
                EXPECT_NEAR(static_cast<double>(start + r.offset), fired[i].time, 1500);
                i++;
            }
        }
        EXPECT_EQ(i, fired.size());
    }
}

TEST(PacketWriter, RefusesWhatAPacketCannotHold)
{
    PacketWriter writer(Model::Vlp16);
    EXPECT_THROW(writer.add(kStart, 0, std::vector<Cell>(15)), std::invalid_argument);
    writer.add(kStart, 0, std::vector<Cell>(16));
    EXPECT_THROW(writer.add(kStart + 60'000, 0, std::vector<Cell>(16)), std::invalid_argument);
    EXPECT_NO_THROW(writer.add(kStart + 55'296, 0, std::vector<Cell>(16)));
}
}  // namespace taut::test
