/** Packets of Hesai's sensors and their correction files, written by hand. */
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "PcapWriter.h"
#include "hesai_packets.h"
#include "import_support.h"
#include "taut/core/Geometry.h"
#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/hesai/FrameAssembler.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using namespace hesai;
using testing::HasSubstr;

std::vector<Return> decode(const HesaiPacket& packet)
{
    std::vector<Return> returns;
    const Model model = *modelOf(packet.bytes.data(), packet.bytes.size());
    decodePacket(packet.bytes.data(), packet.bytes.size(), defaultCalibration(model), returns);
    return returns;
}

std::string refusal(const HesaiPacket& packet)
{
    try
    {
        decode(packet);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "decoded";
}

std::string refusalOf(const std::string& correction)
{
    try
    {
        parseCorrection(correction);
    }
    catch (const CorrectionError& e)
    {
        return e.what();
    }
    return "read";
}

/** A correction file with the data sheet's angles. */
std::string correctionOf(Model model)
{
    std::string text = "Channel,Elevation,Azimuth\n";
    int channel = 1;
    for (const Laser& laser : defaultCalibration(model))
        text += std::to_string(channel++) + "," + std::to_string(laser.elevation * 180 / M_PI) +
                "," + std::to_string(laser.azimuth * 180 / M_PI) + "\n";
    return text;
}

class AHesai : public testing::TestWithParam<HesaiFormat>
{
};

TEST_P(AHesai, PacketGivesPositionTimeAndReflectivity)
{
    const HesaiFormat& format = GetParam();
    HesaiPacket packet(format.model);
    packet.setMicroseconds(250'000);
    const int block = format.blocks - 1, laser = format.lasers - 2;
    packet.setAzimuth(block, 3000);
    packet.setReturn(block, laser, 2500, 201);
    const PacketInfo info = packetInfo(packet.bytes.data(), packet.bytes.size());
    EXPECT_EQ(info.model, format.model);
    EXPECT_EQ(info.returns, 1);
    EXPECT_EQ(info.t, HesaiPacket::kSecond * 1'000'000'000 + 250'000'000);
    const auto returns = decode(packet);
    ASSERT_EQ(returns.size(), 1U);
    EXPECT_EQ(returns[0].block, block);
    EXPECT_EQ(returns[0].laser, laser);
    EXPECT_EQ(returns[0].reflectivity, 201);
    const Laser& direction = defaultCalibration(format.model)[static_cast<std::size_t>(laser)];
    const double a = 30 * M_PI / 180 + direction.azimuth, e = direction.elevation;
    const Vector3d expected(
        10 * std::cos(e) * std::sin(a), 10 * std::cos(e) * std::cos(a), 10 * std::sin(e));
    EXPECT_LT((returns[0].position.cast<double>() - expected).norm(), 1e-5);
}

TEST_P(AHesai, PacketOfAnotherLengthIsRefused)
{
    HesaiPacket packet(GetParam().model);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{11}, packet.tailAt() + 21,
          GetParam().size - 1, GetParam().size + 8, std::size_t{1500}})
    {
        std::vector<std::uint8_t> bytes = packet.bytes;
        bytes.resize(size);
        EXPECT_THROW(packetInfo(bytes.data(), bytes.size()), std::runtime_error) << size;
    }
}

TEST_P(AHesai, CorrectionFileFitsItsOwnSensorOnly)
{
    const Calibration calibration = parseCorrection(correctionOf(GetParam().model));
    for (const HesaiFormat& format : kHesaiFormats)
        if (format.model == GetParam().model)
            EXPECT_NO_THROW(checkCorrection(calibration, format.model));
        else
            EXPECT_THROW(checkCorrection(calibration, format.model), CorrectionError);
}

INSTANTIATE_TEST_SUITE_P(
    Models, AHesai, testing::ValuesIn(kHesaiFormats),
    [](const auto& parameter)
    {
        std::string name = nameOf(parameter.param.model);
        name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
        return name;
    });

/** Since the packet's time stamp [ns]. */
double fired(Model model, int returns, int block, int laser, bool first_loop = true)
{
    return firingTime({model, returns, 0, first_loop}, block, laser);
}

// Numbers of the manuals.
TEST(AHesaiLaser, FiresAtItsOwnTime)
{
    EXPECT_DOUBLE_EQ(fired(Model::Pandar40P, 1, 9, 3), -28580 - 3620);
    EXPECT_DOUBLE_EQ(fired(Model::Pandar40P, 1, 0, 0), -28580 - 9 * 55560 - 42220);
    EXPECT_DOUBLE_EQ(fired(Model::Pandar40P, 2, 0, 0), -28580 - 4 * 55560 - 42220);
    EXPECT_DOUBLE_EQ(fired(Model::Pandar64, 2, 1, 50), -42580 - 2 * 55560 - 3620);
    EXPECT_NEAR(fired(Model::Qt64, 1, 3, 63), 25710 + 500000 + 10000 + 136450, 1);
    EXPECT_NEAR(fired(Model::Qt64, 2, 3, 0), 25710 + 166667 + 10000 + 2310, 1);
    EXPECT_DOUBLE_EQ(fired(Model::Qt128, 1, 1, 0), 9000 + 2312);
    EXPECT_DOUBLE_EQ(fired(Model::Qt128, 1, 0, 32), 9000 - 111110 + 27656);
    EXPECT_DOUBLE_EQ(fired(Model::Qt128, 2, 0, 64, true), 9000 + 1456);
    EXPECT_DOUBLE_EQ(fired(Model::Qt128, 2, 1, 64, false), 9000 + 600);
    EXPECT_DOUBLE_EQ(fired(Model::Xt16, 1, 7, 1), 5632 + 368 + 3024);
    EXPECT_DOUBLE_EQ(fired(Model::Xt32, 2, 1, 31), 5632 - 3 * 50000 + 368 + 31 * 1512);
    EXPECT_DOUBLE_EQ(fired(Model::Xt32M, 3, 2, 17), 5632 - 50000 + 368 + 2888);
}

TEST(AHesaiPacket, OfTwoReturnsHasNoneTwice)
{
    HesaiPacket packet(Model::Xt32);
    packet.setMode(0x39);
    packet.setReturn(2, 0, 1000, 1);
    packet.setReturn(3, 0, 1000, 2);  // the same
    packet.setReturn(2, 1, 1000, 3);
    packet.setReturn(3, 1, 1024, 4);  // 9.6 cm farther
    packet.setReturn(2, 2, 1000, 5);
    packet.setReturn(3, 2, 1025, 6);  // 10 cm farther
    packet.setReturn(2, 3, 1000, 7);  // alone
    const auto returns = decode(packet);
    std::vector<int> kept;
    for (const Return& r : returns) kept.push_back(r.reflectivity);
    EXPECT_THAT(kept, testing::UnorderedElementsAre(2, 4, 5, 6, 7));
}

TEST(AHesaiPacket, LeavesOutWhatIsNearerThanTheSensorSees)
{
    HesaiPacket packet(Model::Xt32M);
    packet.setReturn(0, 0, 124);
    packet.setReturn(0, 1, 125);
    EXPECT_EQ(decode(packet).size(), 1U);
}

TEST(AHesaiPacket, MayCountSecondsInsteadOfADate)
{
    HesaiPacket packet(Model::Xt32);
    packet.setDate({0, 0, 0x64, 0x8b, 0x05, 0xf0});
    EXPECT_EQ(packetInfo(packet.bytes.data(), packet.bytes.size()).t, 0x648b05f0LL * 1'000'000'000);
}

TEST(AHesaiPacket, ThatCannotBeOneIsNamed)
{
    HesaiPacket packet(Model::Xt32);
    packet.setMode(0x40);
    EXPECT_THAT(refusal(packet), HasSubstr("return mode 64"));
    packet.setMode(0x3d);  // three returns in eight blocks
    EXPECT_THAT(refusal(packet), HasSubstr("return mode 61"));
    packet.setMode(0x37);
    packet.setDate({123, 13, 1, 0, 0, 0});
    EXPECT_THAT(refusal(packet), HasSubstr("date"));
    packet = HesaiPacket(Model::Xt32);
    packet.bytes[9] = 0;
    EXPECT_THAT(refusal(packet), HasSubstr("0 mm"));
    HesaiPacket old(Model::Pandar40P);
    old.bytes[124] = 0;
    EXPECT_THAT(refusal(old), HasSubstr("flag"));
}

TEST(ACorrectionFile, IsReadWithWhateverStandsAround)
{
    const Calibration calibration = parseCorrection(
        "EEFF,1,1\r\nLaser id,Elevation,Azimuth\r\n2,-1.5, 0.25\r\n1,15,-1\r\n\r\n0123abcdef\r\n");
    ASSERT_EQ(calibration.size(), 2U);
    EXPECT_DOUBLE_EQ(calibration[0].elevation, 15 * M_PI / 180);
    EXPECT_DOUBLE_EQ(calibration[1].azimuth, 0.25 * M_PI / 180);
}

TEST(ACorrectionFile, ThatIsNoneIsNamed)
{
    const std::string head = "Channel,Elevation,Azimuth\n";
    EXPECT_THAT(refusalOf(""), HasSubstr("no line that names"));
    EXPECT_THAT(refusalOf(head), HasSubstr("no angles"));
    EXPECT_THAT(refusalOf(head + "1,2\n"), HasSubstr("cut short"));
    EXPECT_THAT(refusalOf(head + "1,x,3\n"), HasSubstr("'x' is no number"));
    EXPECT_THAT(refusalOf(head + "1,nan,3\n"), HasSubstr("no number"));
    EXPECT_THAT(refusalOf(head + "1,91,3\n"), HasSubstr("angle"));
    EXPECT_THAT(refusalOf(head + "1,1,3\n1,2,3\n"), HasSubstr("twice"));
    EXPECT_THAT(refusalOf(head + "1,1,3\n3,2,3\n"), HasSubstr("channel 2 is missing"));
    EXPECT_THAT(refusalOf(head + "4000000000,1,3\n"), HasSubstr("'4000000000' is none"));
}

/** A capture with two turns and a bit. */
class AHesaiCapture : public testing::Test
{
 protected:
    AHesaiCapture()
    {
        PcapWriter pcap(folder_ / "run.pcap");
        Time t = HesaiPacket::kSecond * 1'000'000'000;
        for (const auto& packet : xt32Packets(510)) pcap.write(t += 400'000, 2368, packet);
    }

    Imported import(const std::string& correction = "")
    {
        ImportOptions options;
        options.hesai_csv = correction;
        return importAll(folder_ / "run.pcap", options);
    }

    std::string write(const std::string& name, const std::string& text)
    {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }

    TemporaryFolder folder_;
};

TEST_F(AHesaiCapture, BecomesTurns)
{
    const Imported all = import();
    EXPECT_EQ(all.failure, "");
    ASSERT_EQ(all.scans.size(), 3U);
    EXPECT_EQ(all.scans[1].points.size(), 2000U * 32);
    EXPECT_EQ(all.scans[1].rings, 32);
    const Time first = HesaiPacket::kSecond * 1'000'000'000 + 5632 - 7 * 50'000 + 368;
    EXPECT_EQ(all.scans[0].stamp, first);
    EXPECT_EQ(all.scans[1].stamp, first + 100'000'000);
    EXPECT_EQ(all.scans[1].end - all.scans[1].stamp, 1999 * 50'000 + 31 * 1512);
    EXPECT_THAT(all.findings, testing::Contains(HasSubstr("PandarXT, one return: 510 packets")));
    EXPECT_THAT(all.findings, testing::Contains(HasSubstr("the data sheet's")));
}

TEST_F(AHesaiCapture, TakesTheCorrectionFileBesideIt)
{
    std::string angles = correctionOf(Model::Xt32);
    angles.replace(angles.find("15.000000"), 9, "14.500000");
    write("imu.csv", "t,x\n1,2\n");
    write("XT32M.csv", correctionOf(Model::Xt32M));
    const std::string fitting = write("XT32.csv", angles);
    Imported all = import();
    EXPECT_THAT(all.findings, testing::Contains("angles: " + fitting));
    EXPECT_NEAR(all.scans[0].points[0].position.z(), 10 * std::sin(14.5 * M_PI / 180), 1e-5);
    const std::string own = write("run.csv", angles);
    EXPECT_THAT(import().findings, testing::Contains("angles: " + own));
    EXPECT_THAT(import(fitting).findings, testing::Contains("angles: " + fitting));
    std::filesystem::remove(own);
    write("XT32 old.csv", angles);
    EXPECT_THAT(import().failure, HasSubstr("both fit"));
}

TEST_F(AHesaiCapture, WithACorrectionFileOfAnotherSensorFails)
{
    const std::string other = write("other", correctionOf(Model::Pandar40P));
    EXPECT_THAT(import(other).failure, HasSubstr("it has 40 lasers, a PandarXT has 32"));
    EXPECT_THAT(import(folder_ / "none.csv").failure, HasSubstr("cannot read"));
    write("run.csv", correctionOf(Model::Xt32M));
    EXPECT_THAT(import().failure, HasSubstr("of another sensor: the elevation of channel 1"));
}

TEST(AHesaiDecoder, NeedsNoRecordingForTheAnglesOfTheDataSheet)
{
    const auto decoder = makeHesaiDecoder("", "", StampClock::Sensor);
    ImportedItems items;
    UdpDatagram datagram;
    datagram.payload = HesaiPacket(Model::Xt32).bytes;
    decoder->add(datagram, items);
    EXPECT_EQ(decoder->findings().at(0), "Hesai PandarXT, one return: 1 packets");
}

TEST_F(AHesaiCapture, OfASensorThatIsNotKnownIsNamed)
{
    auto packets = xt32Packets(3);
    {
        PcapWriter pcap(folder_ / "run.pcap");
        for (auto& packet : packets)
        {
            packet[2] = 4;
            packet[3] = 3;
            pcap.write(kStart, 2368, packet);
        }
    }
    EXPECT_THAT(import().failure, HasSubstr("protocol 4.3 with 32 lasers and 8 blocks"));
}
}  // namespace
}  // namespace taut::test
