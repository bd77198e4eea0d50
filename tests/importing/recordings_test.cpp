/** The captures that may not be copied here (TAUT_DATA), against the facts of an independent
 * decoder that lie beside them. */
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "data_folder.h"
#include "import_support.h"
#include "kitti_support.h"
#include "taut/rawlog/RawlogSource.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
class ACapture : public testing::Test
{
 protected:
    /** False where the capture is absent. */
    bool import(const std::string& name)
    {
        const auto pcap = dataFolder() / "pcap" / (name + ".pcap");
        if (!std::filesystem::exists(pcap)) return false;
        facts_ =
            nlohmann::json::parse(std::ifstream(dataFolder() / "pcap" / (name + ".facts.json")));
        all_ = importAll(pcap.string());
        EXPECT_EQ(all_.failure, "");
        EXPECT_TRUE(all_.warnings.counts().empty());
        return true;
    }

    nlohmann::json facts_;
    Imported all_;
};

class AVelodyneRecording : public ACapture, public testing::WithParamInterface<const char*>
{
};

TEST_P(AVelodyneRecording, HasTheReturnsRevolutionsAndTimesOfItsFacts)
{
    if (!import(GetParam())) return skipWithout(GetParam() + std::string(".pcap"));
    EXPECT_EQ(all_.packet_scans.size(), facts_["valid_returns_per_revolution"].size());
    EXPECT_EQ(all_.packet_scans.size(), facts_["zero_crossings"].get<std::size_t>() + 1);

    std::size_t packets = 0, valid = 0;
    std::vector<std::size_t> per_revolution(1);
    int last_azimuth = -1;
    std::vector<velodyne::Return> returns;
    for (const PacketScan& scan : all_.packet_scans)
        for (const auto& packet : scan.packets)
        {
            packets++;
            returns.clear();
            const auto info = velodyne::packetInfo(packet.data());
            velodyne::decodePacket(
                packet.data(), velodyne::defaultCalibration(info.model), returns);
            valid += returns.size();
            auto next = returns.begin();
            for (int block = 0; block < velodyne::kBlocks; block++)
            {
                const int azimuth = velodyne::blockAzimuth(packet.data(), block);
                if (azimuth < last_azimuth) per_revolution.push_back(0);
                last_azimuth = azimuth;
                for (; next != returns.end() && next->block == block; ++next)
                    per_revolution.back()++;
            }
        }
    EXPECT_EQ(packets, facts_["data_packets"]);
    EXPECT_EQ(valid, facts_["valid_returns_total"]);
    EXPECT_EQ(nlohmann::json(per_revolution), facts_["valid_returns_per_revolution"]);

    const PacketScan& first = all_.packet_scans.front();
    const PacketScan& last = all_.packet_scans.back();
    const Duration hour = 3'600'000'000'000;
    EXPECT_EQ(first.stamp % hour, facts_["device_us_first"].get<Time>() * 1000);
    velodyne::PacketClock clock;
    Duration in_last = 0;
    for (const auto& packet : last.packets)
        in_last = clock.sinceFirst(velodyne::packetInfo(packet.data()).microseconds);
    EXPECT_NEAR(
        toSeconds(last.stamp + in_last - first.stamp), facts_["device_time_span_s"].get<double>(),
        1e-9);
    const double captured = facts_["pcap_time_first"].get<double>();
    EXPECT_LT(std::abs(toSeconds(first.stamp) - captured), 1800);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, AVelodyneRecording, testing::Values("vlp16_5hz", "vlp16_gps", "hdl32"),
    [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(ACapture, OfAnOusterHasTheFramesTimesAndForcesOfItsFacts)
{
    if (!import("ouster_os1_128")) return skipWithout("ouster_os1_128.pcap");
    const auto& frames = facts_["frames"];
    ASSERT_EQ(all_.scans.size(), frames.size());
    const Duration shift = all_.scans[0].stamp - frames[0]["t_first_ns"].get<Time>();
    EXPECT_EQ(shift % 1'000'000'000, 0);
    for (std::size_t i = 0; i < frames.size(); i++)
    {
        const Scan& scan = all_.scans[i];
        EXPECT_EQ(scan.points.size(), frames[i]["valid_returns"]);
        EXPECT_EQ(scan.stamp - shift, frames[i]["t_first_ns"]);
        EXPECT_EQ(scan.end - shift, frames[i]["t_last_ns"]);
        double reflectivity = 0;
        for (const LidarPoint& p : scan.points) reflectivity += p.intensity;
        EXPECT_NEAR(
            reflectivity / static_cast<double>(scan.points.size()),
            frames[i]["mean_reflectivity_of_valid"].get<double>(), 1e-9);
    }
    Pose T_imu_lidar;
    for (int row = 0; row < 3; row++)
    {
        for (int column = 0; column < 3; column++)
            T_imu_lidar.R(row, column) = facts_["T_imu_lidar"][row][column];
        T_imu_lidar.p[row] = facts_["T_imu_lidar"][row][3];
    }
    EXPECT_LT((all_.scans[0].T_imu_lidar.R - T_imu_lidar.R).norm(), 1e-9);
    EXPECT_LT((all_.scans[0].T_imu_lidar.p - T_imu_lidar.p).norm(), 1e-9);

    ASSERT_EQ(all_.imu.size(), facts_["imu_packets"]);
    EXPECT_EQ(all_.imu.front().t - shift, facts_["imu_first_ns"]);
    EXPECT_EQ(all_.imu.back().t - shift, facts_["imu_last_ns"]);
    Vector3d accel = Vector3d::Zero(), gyro = Vector3d::Zero();
    for (const ImuSample& s : all_.imu)
    {
        accel += s.accel / static_cast<double>(all_.imu.size());
        gyro += s.gyro / static_cast<double>(all_.imu.size());
    }
    for (int i = 0; i < 3; i++)
    {
        EXPECT_NEAR(accel[i], facts_["imu_acc_mean_ms2"][i].get<double>(), 1e-6);
        EXPECT_NEAR(gyro[i], facts_["imu_gyro_mean_rads"][i].get<double>(), 1e-6);
    }
}

// A drive of KITTI-360 that somebody else gave times to, without them: they come back.
TEST(AKitti360Drive, GetsTheTimesOfAnIndependentConversionFromTheAzimuth)
{
    const auto log = dataFolder() / "street_hdl64.rawlog";
    if (!std::filesystem::exists(log)) return skipWithout("street_hdl64.rawlog");
    const TemporaryFolder folder;
    const std::string drive = folder / "data_3d_raw/drive";
    std::filesystem::create_directories(drive + "/velodyne_points/data");
    RawlogConfig config;
    config.path = log.string();
    config.only_first_n = 3;
    RawlogSource source(config);
    std::vector<Scan> scans;
    while (const auto measurement = source.next())
        if (const auto* scan = std::get_if<Scan>(&*measurement)) scans.push_back(*scan);
    ASSERT_EQ(scans.size(), 3U);
    std::ofstream stamps(drive + "/velodyne_points/timestamps.txt");
    for (std::size_t k = 0; k < scans.size(); k++)
    {
        const Duration half = (scans[1].stamp - scans[0].stamp) / 2;
        stamps << dateText(scans[k].stamp + half) << "\n";
        writeBin(drive + "/velodyne_points/data/" + frameName(k, ".bin"), scans[k]);
    }
    stamps.close();

    const Imported all = importAll(drive);
    ASSERT_EQ(all.scans.size(), 3U) << all.failure;
    std::size_t differing = 0;
    for (std::size_t k = 0; k < scans.size(); k++)
    {
        ASSERT_EQ(all.scans[k].points.size(), scans[k].points.size());
        for (std::size_t i = 0; i < scans[k].points.size(); i++)
        {
            const Duration difference =
                all.scans[k].timeOf(all.scans[k].points[i]) - scans[k].timeOf(scans[k].points[i]);
            differing += std::abs(difference) > kMillisecond;
        }
    }
    EXPECT_LT(differing, 100U);  // exactly at the back, begin and end are the same to an azimuth
}
}  // namespace
}  // namespace taut::test
