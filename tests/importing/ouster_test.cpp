#include <gmock/gmock.h>

#include <fstream>

#include "OusterSimulator.h"
#include "PcapWriter.h"
#include "import_support.h"
#include "taut/packets/ouster/Decoder.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using namespace taut::ouster;
using testing::HasSubstr;

void write(const OusterSimulator& sensor, PcapWriter& pcap, int frames)
{
    for (int frame = 0; frame < frames; frame++)
        for (int i = 0; i < sensor.packetsPerFrame(); i++)
            pcap.write(
                kStart + sensor.columnTime(frame, (i + 1) * sensor.columns_per_packet - 1) -
                    sensor.device_start + kMillisecond,
                7502, sensor.packet(frame, i));
}

void describe(const OusterSimulator& sensor, const std::string& path)
{
    std::ofstream(path) << sensor.description();
}

void expectPoints(const OusterSimulator& sensor, int frame, const Scan& scan)
{
    std::size_t i = 0;
    for (int column = 0; column < sensor.columns; column++)
        for (int pixel = 0; pixel < sensor.pixels; pixel++)
        {
            if (sensor.range_mm(frame, column, pixel) == 0) continue;
            ASSERT_LT(i, scan.points.size());
            const LidarPoint& p = scan.points[i++];
            ASSERT_LT(
                (p.position.cast<double>() - sensor.point(frame, column, pixel)).norm(), 1e-5);
            ASSERT_EQ(p.offset, column * sensor.columnPeriod());
            ASSERT_EQ(p.ring, pixel);
            ASSERT_EQ(p.intensity, 100 + pixel);
        }
    EXPECT_EQ(i, scan.points.size());
    EXPECT_EQ(scan.end - scan.stamp, (sensor.columns - 1) * sensor.columnPeriod());
}

class AnOuster : public testing::TestWithParam<const char*>
{
 protected:
    AnOuster() { sensor_.profile = GetParam(); }

    TemporaryFolder folder_;
    OusterSimulator sensor_;
};

TEST_P(AnOuster, GivesTheSamePointsThroughItsPackets)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 3);
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = importAll(folder_ / "a.pcap");
    EXPECT_EQ(all.failure, "");
    ASSERT_EQ(all.scans.size(), 3U);
    for (int frame = 0; frame < 3; frame++) expectPoints(sensor_, frame, all.scans[frame]);
    EXPECT_EQ(all.scans[1].stamp - all.scans[0].stamp, 100 * kMillisecond);
    EXPECT_EQ(all.warnings.count("no_imu"), 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Profiles, AnOuster,
    testing::Values(
        "LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8",
        "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"),
    [](const auto& parameter) { return std::string(parameter.param); });

class AnOusterCapture : public testing::Test
{
 protected:
    Imported import(const ImportOptions& options = {}) const
    {
        return importAll(folder_ / "a.pcap", options);
    }

    TemporaryFolder folder_;
    OusterSimulator sensor_;
};

TEST_F(AnOusterCapture, IsPutTogetherFromFragmentsInAnyOrder)
{
    for (const bool reversed : {false, true})
    {
        {
            PcapWriter pcap(folder_ / "a.pcap");
            pcap.last_fragment_first = reversed;
            pcap.vlan_tags = reversed ? 1 : 0;
            pcap.mtu = 576;
            write(sensor_, pcap, 2);
        }
        describe(sensor_, folder_ / "a.json");
        const Imported all = import();
        ASSERT_EQ(all.scans.size(), 2U) << all.failure;
        for (int frame = 0; frame < 2; frame++) expectPoints(sensor_, frame, all.scans[frame]);
        EXPECT_EQ(all.warnings.count("fragments_lost"), 0U);
    }
}

TEST_F(AnOusterCapture, WithALostFragmentSaysSo)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 1);
        pcap.lose_fragment = true;
        write(sensor_, pcap, 1);
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 1U);
    EXPECT_EQ(all.warnings.count("fragments_lost"), 1U);
}

TEST_F(AnOusterCapture, GivesRatesAndForcesInSiUnits)
{
    ImuSample sample{6'000'000'000, {0.1, -0.2, 3}, {0.5, 1, 9.7}};
    {
        PcapWriter pcap(folder_ / "a.pcap");
        pcap.write(kStart, 7503, OusterSimulator::imuPacket(sample));
        write(sensor_, pcap, 1);
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    ASSERT_EQ(all.imu.size(), 1U);
    EXPECT_LT((all.imu[0].gyro - sample.gyro).norm(), 1e-6);
    EXPECT_LT((all.imu[0].accel - sample.accel).norm(), 1e-6);
    EXPECT_EQ(all.warnings.counts().size(), 0U);
    ASSERT_EQ(all.scans.size(), 1U);
    const Pose T = all.scans[0].T_imu_lidar;
    EXPECT_LT((T.p - Vector3d(-0.006253, 0.011775, 0.028535)).norm(), 1e-9);
    EXPECT_LT((T.R - Matrix3d(Vector3d(-1, -1, 1).asDiagonal())).norm(), 1e-9);
}

TEST_F(AnOusterCapture, HasItsBootClockPutOnTheDayByWholeSecondsOrTheCapturesClock)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 2);
    }
    describe(sensor_, folder_ / "a.json");
    const Imported sensor_time = import();
    ASSERT_EQ(sensor_time.scans.size(), 2U);
    EXPECT_EQ((sensor_time.scans[0].stamp - sensor_.device_start) % 1'000'000'000, 0);
    EXPECT_LT(std::abs(sensor_time.scans[0].stamp - kStart), 600 * kMillisecond);

    ImportOptions options;
    options.capture_clock = true;
    const Imported capture_time = import(options);
    ASSERT_EQ(capture_time.scans.size(), 2U);
    EXPECT_NEAR(toSeconds(capture_time.scans[1].stamp - kStart), 0.101, 2e-6);
    expectPoints(sensor_, 1, capture_time.scans[1]);

    sensor_.device_start = kStart + 123;  // synchronised
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 1);
    }
    EXPECT_EQ(import().scans.at(0).stamp, kStart + 123);
}

TEST_F(AnOusterCapture, WithTheDescriptionOfAnotherSensorIsRefused)
{
    sensor_.profile = "RNG15_RFL8_NIR8";
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 3);
    }
    EXPECT_THAT(import().failure, HasSubstr("give its description with --ouster-json"));

    const auto refusal = [this](void (*change)(OusterSimulator&))
    {
        OusterSimulator other = sensor_;
        change(other);
        describe(other, folder_ / "a.json");
        return import().failure;
    };
    EXPECT_THAT(refusal([](auto& s) { s.pixels = 32; }), HasSubstr("bytes where the description"));
    EXPECT_THAT(refusal([](auto& s) { s.profile = "LEGACY"; }), HasSubstr("bytes where"));
    EXPECT_THAT(refusal([](auto& s) { s.serial = 17; }), HasSubstr("description of 17"));
    EXPECT_THAT(refusal([](auto& s) { s.columns = 32; }), HasSubstr("another lidar mode"));
    EXPECT_THAT(refusal([](auto& s) { s.columns = 128; }), HasSubstr("another lidar mode"));
    EXPECT_THAT(
        refusal([](auto& s) { s.profile = "RNG99"; }), HasSubstr("'RNG99' cannot be decoded"));
    EXPECT_EQ(refusal([](auto&) {}), "");
}

TEST_F(AnOusterCapture, WithForeignDatagramsToItsPortLeavesThemOut)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        pcap.from = 0xc0a80107;
        pcap.write(kStart - kMillisecond, 7502, std::vector<std::uint8_t>(544, 7));  // DDS
        pcap.from = 0xc0a801c9;
        write(sensor_, pcap, 2);
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 2U) << all.failure;
    expectPoints(sensor_, 1, all.scans[1]);
    EXPECT_EQ(all.warnings.counts().size(), all.warnings.count("no_imu"));
    EXPECT_THAT(
        all.findings, testing::Contains(HasSubstr("1 datagrams to the ports of the Ouster")));
}

TEST_F(AnOusterCapture, IsThatOfTheSenderThatTheDescriptionIsOf)
{
    sensor_.profile = "RNG19_RFL8_SIG16_NIR16";
    OusterSimulator other = sensor_;
    other.serial = 17;
    other.range_mm = [](int, int, int) { return 4000U; };
    const ImuSample sample{6'000'000'000, {0.1, -0.2, 3}, {0.5, 1, 9.7}};
    {
        PcapWriter pcap(folder_ / "a.pcap");
        for (int frame = 0; frame < 3; frame++)
            for (int i = 0; i < sensor_.packetsPerFrame(); i++)
            {
                const Time t = kStart + sensor_.columnTime(frame, i * 16) - sensor_.device_start;
                pcap.from = 0xc0a80107;
                pcap.write(t, 7503, OusterSimulator::imuPacket({}));
                pcap.write(t, 7502, other.packet(frame, i));
                pcap.from = 0xc0a801c9;
                pcap.write(t, 7502, sensor_.packet(frame, i));
            }
        pcap.write(kStart + 200 * kMillisecond, 7503, OusterSimulator::imuPacket(sample));
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 3U) << all.failure;
    for (int frame = 0; frame < 3; frame++) expectPoints(sensor_, frame, all.scans[frame]);
    EXPECT_EQ(all.imu.size(), 1U);
    EXPECT_EQ(all.warnings.count("second_sensor"), 1U);
    EXPECT_THAT(all.warnings.kept().at(0).text, HasSubstr("192.168.1.7"));
}

TEST_F(AnOusterCapture, OfPacketsThatCameTwiceOrSwappedIsTheSame)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        const int n = sensor_.packetsPerFrame();
        for (int k = 0; k < 3 * n; k++)
        {
            const int swapped = k % n == 0 ? k + 1 : k % n == 1 ? k - 1 : k;
            for (int copy = 0; copy < 2; copy++)
                pcap.write(kStart, 7502, sensor_.packet(swapped / n, swapped % n));
        }
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 3U) << all.failure;
    for (const Scan& scan : all.scans)
    {
        EXPECT_EQ(scan.points.size(), all.scans[0].points.size());
        EXPECT_EQ(scan.end - scan.stamp, (sensor_.columns - 1) * sensor_.columnPeriod());
        for (const LidarPoint& point : scan.points) ASSERT_GE(point.offset, 0);
    }
    EXPECT_EQ(all.scans[1].stamp - all.scans[0].stamp, 100 * kMillisecond);
    EXPECT_THAT(all.findings, testing::Contains(HasSubstr("12 packets came twice")));
}

TEST_F(AnOusterCapture, WithPacketsLeftOutStillEnds)
{
    {
        PcapWriter pcap(folder_ / "a.pcap");
        write(sensor_, pcap, 1);
        pcap.write(kStart, 7502, sensor_.packet(3, 0));
        pcap.write(kStart, 7502, sensor_.packet(1, 0));  // late
        pcap.write(kStart, 7503, std::vector<std::uint8_t>(20));
    }
    describe(sensor_, folder_ / "a.json");
    const Imported all = import();
    EXPECT_EQ(all.failure, "");
    ASSERT_EQ(all.scans.size(), 2U);
    EXPECT_EQ(all.warnings.count("packets_late"), 1U);
    EXPECT_EQ(all.warnings.count("packet_invalid"), 1U);
}

std::string refusal(const std::string& json)
{
    try
    {
        parseSensorInfo(json);
    }
    catch (const std::runtime_error& e)  // no other one: its callers know none
    {
        return e.what();
    }
    return "";
}

TEST(AnOusterDescription, NamesWhatIsWrongInIt)
{
    const auto good = OusterSimulator().description();
    const auto with = [&good](const char* key, const nlohmann::json& value)
    {
        auto j = good;
        j[key] = value;
        return refusal(j.dump());
    };
    EXPECT_EQ(refusal(good.dump()), "");
    EXPECT_THAT(refusal("[1]"), HasSubstr("no JSON object"));
    EXPECT_THAT(refusal("{"), HasSubstr("parse error"));
    EXPECT_THAT(refusal("{\"lidar_mode\": \"1024x10\"}"), HasSubstr("beam_altitude_angles"));
    EXPECT_THAT(with("beam_azimuth_angles", {1, 2}), HasSubstr("2 angles for 16 pixels"));
    EXPECT_THAT(with("beam_azimuth_angles", "no"), HasSubstr("not of the right type"));
    EXPECT_THAT(with("imu_to_sensor_transform", {1, 2}), HasSubstr("no 4 x 4 matrix"));
    EXPECT_THAT(with("imu_to_sensor_transform", std::vector<double>(16, 1)), HasSubstr("no rigid"));
    // Casts of these overflowed, or gave another number.
    EXPECT_THAT(with("data_format", {{"columns_per_packet", 1e300}}), HasSubstr("impossible"));
    EXPECT_THAT(with("udp_port_lidar", 70000), HasSubstr("'udp_port_lidar' is impossible"));
    auto turning = good;
    turning["lidar_mode"] = "1024xnan";
    EXPECT_EQ(parseSensorInfo(turning.dump()).frame_rate, 0);
}

TEST(AnOusterDescription, OfOldFirmwareTakesTheUsualBeamOrigin)
{
    auto j = OusterSimulator().description();
    j.erase("lidar_origin_to_beam_origin_mm");
    for (const auto& [model, origin] :
         {std::pair("OS-0-128", 0.02767), std::pair("OS-1-64", 0.015806),
          std::pair("OS-2-32", 0.013762), std::pair("", 0.012163)})
    {
        j["prod_line"] = model;
        EXPECT_NEAR(parseSensorInfo(j.dump()).beam_origin.x(), origin, 1e-9) << model;
    }
}

TEST(AnOusterDescription, OfNewFirmwareIsReadFromItsSections)
{
    const auto flat = OusterSimulator().description();
    nlohmann::json nested;
    nested["sensor_info"] = {{"prod_line", "OS-1-16"}, {"prod_sn", "7"}};
    nested["beam_intrinsics"] = {
        {"beam_altitude_angles", flat["beam_altitude_angles"]},
        {"beam_azimuth_angles", flat["beam_azimuth_angles"]},
        {"lidar_origin_to_beam_origin_mm", 15.806},
        {"beam_to_lidar_transform", {1, 0, 0, 15, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1}}};
    nested["lidar_data_format"] = flat["data_format"];
    nested["config_params"] = {{"lidar_mode", "64x20"}, {"udp_port_lidar", 8000}};
    const SensorInfo info = parseSensorInfo(nested.dump());
    EXPECT_EQ(info.serial, 7U);
    EXPECT_EQ(info.columns_per_frame, 64);
    EXPECT_EQ(info.frame_rate, 20);
    EXPECT_EQ(info.lidar_port, 8000);
    EXPECT_EQ(info.beam_altitudes.size(), 16U);
    EXPECT_LT((info.beam_origin - Vector3d(0.015, 0, 0.002)).norm(), 1e-12);
}
}  // namespace
}  // namespace taut::test
