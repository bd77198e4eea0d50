/** Recordings with bytes changed or cut off at random: whatever comes out, nothing crashes or
 * hangs, and what is not used is said. */
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "OusterSimulator.h"
#include "PcapWriter.h"
#include "kitti_support.h"
#include "reference.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
namespace fs = std::filesystem;

std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/** Imports a recording again and again with its file damaged each time otherwise. */
void damage(const std::string& recording, const std::string& file, int runs)
{
    const std::string good = contentOf(file);
    ASSERT_FALSE(good.empty());
    const Imported whole = importAll(recording);
    ASSERT_EQ(whole.failure, "");
    const auto last = static_cast<double>(good.size() - 1);
    Random random(7);
    for (int run = 0; run < runs; run++)
    {
        std::string bad = good;
        for (int i = 0; i < 1 + run % 20; i++)
            bad[static_cast<std::size_t>(random.uniform(0, last))] =
                static_cast<char>(random.uniform(-128, 127));
        if (run % 3 == 0) bad.resize(static_cast<std::size_t>(random.uniform(0, last)));
        std::ofstream(file, std::ios::binary) << bad;
        const Imported all = importAll(recording);
        EXPECT_LE(all.scans.size(), whole.scans.size() + 20);
        const bool nothing = all.scans.empty() && all.packet_scans.empty();
        EXPECT_TRUE(!nothing || !all.failure.empty());
    }
}

TEST(ADamagedRecording, OfAVelodyneNeverCrashes)
{
    const TemporaryFolder folder;
    {
        PcapWriter pcap(folder / "a.pcap");
        velodyne::PacketWriter writer(velodyne::Model::Vlp16);
        for (int i = 0; i < 24 * 90; i++)
            writer.add(
                kStart + std::llround(i * 55296.0), std::fmod(0.2 * i, 360),
                std::vector<velodyne::Cell>(16, {5, 7}));
        for (const auto& packet : writer.take()) pcap.write(kStart, 2368, packet);
    }
    damage(folder / "a.pcap", folder / "a.pcap", 60);
}

TEST(ADamagedRecording, OfAnOusterNeverCrashes)
{
    const TemporaryFolder folder;
    OusterSimulator sensor;
    {
        PcapWriter pcap(folder / "a.pcap");
        for (int frame = 0; frame < 2; frame++)
            for (int i = 0; i < sensor.packetsPerFrame(); i++)
            {
                pcap.write(kStart, 7502, sensor.packet(frame, i));
                pcap.write(kStart, 7503, OusterSimulator::imuPacket({i * kMillisecond, {}, {}}));
            }
    }
    std::ofstream(folder / "a.json") << sensor.description();
    damage(folder / "a.pcap", folder / "a.pcap", 100);
    {
        PcapWriter pcap(folder / "a.pcap");
        for (int i = 0; i < sensor.packetsPerFrame(); i++)
            pcap.write(kStart, 7502, sensor.packet(0, i));
    }
    damage(folder / "a.pcap", folder / "a.json", 200);
}

TEST(ADamagedRecording, InFoldersNeverCrashes)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in";
    fs::create_directories(in);
    std::ofstream(in + "/imu.csv") << "t gyro_x gyro_y gyro_z accel_x accel_y accel_z\n"
                                      "1 0 0 0 0 0 9.8\n2 0 0 0 0 0 9.8\n";
    std::ofstream(in + "/1.csv") << "x,y,z,t,ring\n1,2,3,1.1,0\n2,3,4,1.2,1\n";
    std::ofstream(in + "/2.ply") << "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                                    "property float y\nproperty float z\nproperty double t\n"
                                    "end_header\n1 2 3 1.3\n1 2 4 1.4\n";
    std::ofstream(in + "/3.pcd") << "FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F F\nPOINTS 2\n"
                                    "DATA ascii\n1 2 3 1.5\n1 2 4 1.6\n";
    for (const char* file : {"/imu.csv", "/1.csv", "/2.ply", "/3.pcd"})
    {
        const std::string good = contentOf(in + file);
        damage(in, in + file, 100);
        std::ofstream(in + file, std::ios::binary) << good;
    }
    const std::string odometry = folder / "07";
    fs::create_directories(odometry + "/velodyne");
    std::ofstream(odometry + "/times.txt") << "0.0\n0.1\n";
    writeBin(odometry + "/velodyne/" + frameName(0, ".bin"), Reference(1).turn(0));
    damage(odometry, odometry + "/velodyne/" + frameName(0, ".bin"), 30);
}
}  // namespace
}  // namespace taut::test
