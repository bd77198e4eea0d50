#include "../importing/OusterSimulator.h"
#include "../importing/PcapWriter.h"
#include "../importing/bag_support.h"
#include "../importing/hesai_packets.h"
#include "../importing/kitti_support.h"
#include "../support/velodyne_bytes.h"
#include "seeds.h"
#include "support.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut::fuzz
{
using namespace taut::test;

namespace
{
using Packets = std::vector<Blob>;

/** A part of a turn that sees 10 m all around. */
Packets velodynePackets(velodyne::Model model, int count, int first_azimuth)
{
    Packets packets;
    const double period = velodyne::firingPattern(model).blockPeriod();
    for (int i = 0; i < count; i++)
    {
        Blob packet(velodyne::kPacketBytes);
        const double begin = 12 * period * i;  // [ns]
        for (std::size_t block = 0; block < 12; block++)
        {
            const auto azimuth = static_cast<std::uint16_t>(
                std::lround(
                    first_azimuth + 360e-6 * (begin + period * static_cast<double>(block))) %
                36000);
            packet[100 * block] = 0xff;
            packet[100 * block + 1] = 0xee;
            std::memcpy(&packet[100 * block + 2], &azimuth, 2);
            for (std::size_t slot = 0; slot < 32; slot++) packet[100 * block + 5 + 3 * slot] = 10;
        }
        const auto us = static_cast<std::uint32_t>(1'000'000 + std::llround(begin / 1000));
        std::memcpy(&packet[1200], &us, 4);
        packet[1204] = 0x37;
        packet[1205] = static_cast<std::uint8_t>(model);
        packets.push_back(packet);
    }
    return packets;
}

Packets hesaiPackets(const HesaiFormat& format, int count)
{
    Packets packets;
    for (int i = 0; i < count; i++)
    {
        HesaiPacket packet(format.model);
        for (int block = 0; block < format.blocks; block++)
        {
            packet.setAzimuth(block, (35900 + 18 * (i * format.blocks + block)) % 36000);
            for (int laser = 0; laser < format.lasers; laser++)
                packet.setReturn(block, laser, 2500, laser);
        }
        packet.setMicroseconds(400 * i);
        packets.push_back(packet.bytes);
    }
    return packets;
}

Packets ousterPackets(const OusterSimulator& sensor)
{
    Packets packets;
    for (int frame = 0; frame < 2; frame++)
        for (int i = 0; i < sensor.packetsPerFrame(); i++)
        {
            packets.push_back(sensor.packet(frame, i));
            packets.push_back(OusterSimulator::imuPacket(
                {sensor.columnTime(frame, i * sensor.columns_per_packet),
                 {0.1, 0, 0.2},
                 {0, 0, 9.8}}));
        }
    return packets;
}

void writeCapture(const std::string& path, int link, std::uint16_t port, const Packets& packets)
{
    PcapWriter pcap(path, link);
    pcap.vlan_tags = port == 2369 ? 1 : 0;
    Time t = 1'700'000'000'000'000'000;
    for (const Blob& packet : packets)
        pcap.write(t += 1'000'000, packet.size() == 48 ? 7503 : port, packet);
}

void addPacketSeeds(const Seeds& seeds)
{
    for (const auto model :
         {velodyne::Model::Hdl32, velodyne::Model::Vlp16, velodyne::Model::Vlp32,
          velodyne::Model::Vls128})
    {
        const std::string name = "model_" + std::to_string(static_cast<int>(model));
        const Packets packets = velodynePackets(model, 6, 35900);
        seeds.add("velodyne_packets", name, '\0' + joinPieces(packets));
        seeds.add("velodyne_packets", name + "_kept", '\x81' + joinPieces(packets));
        writeCapture(seeds.file("capture", "velodyne_" + name), DLT_EN10MB, 2368, packets);
    }
    const auto known = knownPacket();
    writeCapture(
        seeds.file("capture", "known_packet"), DLT_LINUX_SLL, 2368, {{known.begin(), known.end()}});
    for (const HesaiFormat& format : kHesaiFormats)
    {
        const Packets packets = hesaiPackets(format, 6);
        seeds.add("hesai_packets", hesai::nameOf(format.model), '\0' + joinPieces(packets));
        writeCapture(
            seeds.file("capture", "hesai_" + hesai::nameOf(format.model)), DLT_RAW, 2368, packets);
        std::string correction = "Channel,Elevation,Azimuth\n";
        int channel = 1;
        for (const hesai::Laser& laser : hesai::defaultCalibration(format.model))
            correction += std::to_string(channel++) + "," +
                          std::to_string(laser.elevation * 180 / M_PI) + "," +
                          std::to_string(laser.azimuth * 180 / M_PI) + "\n";
        seeds.add("hesai_csv", hesai::nameOf(format.model), correction);
    }
    char choice = 0;
    for (const char* profile :
         {"LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8",
          "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"})
    {
        OusterSimulator sensor;
        sensor.profile = profile;
        seeds.add("ouster_json", profile, sensor.description().dump(1));
        seeds.add("ouster_packets", profile, choice++ + joinPieces(ousterPackets(sensor)));
    }
    for (const int link : {DLT_EN10MB, DLT_NULL, DLT_LINUX_SLL2})
        writeCapture(
            seeds.file("capture", "ouster_" + std::to_string(link)), link, 7502,
            ousterPackets(OusterSimulator()));
    // A block of a section and one of an interface, then a packet (RFC draft pcapng).
    std::string ng(
        "\x0a\x0d\x0d\x0a\x1c\0\0\0\x4d\x3c\x2b\x1a\1\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff\x1c\0\0"
        "\0",
        28);
    ng += std::string("\1\0\0\0\x14\0\0\0\1\0\0\0\0\0\0\0\x14\0\0\0", 20);
    ng += std::string(
        "\6\0\0\0\x28\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\6\0\0\0\6\0\0\0abcdef\0\0\x28\0\0\0", 40);
    seeds.add("capture", "pcapng", ng);
}

Blob packetMessage(const std::string& type, TestWire wire, const Packets& packets)
{
    WireWriter out(wire);
    out.header(kBagStart);
    out.number(static_cast<std::uint32_t>(packets.size()));
    for (const Blob& packet : packets)
    {
        out.number(std::uint32_t{1'700'000'000});
        out.number(std::uint32_t{0});
        if (type == "nebula_msgs/NebulaPackets")
        {
            out.bytes(packet);
            continue;
        }
        for (const std::uint8_t byte : packet) out.number(byte);
        if (type != "pandar_msgs/PandarScan") continue;
        for (std::size_t i = packet.size(); i < 1500; i++) out.number(std::uint8_t{0});
        out.number(static_cast<std::uint32_t>(packet.size()));
    }
    return out.message();
}

/** Small bags with each kind of message. */
std::vector<std::pair<std::string, TestMessages>> bagsOf(TestWire wire)
{
    const auto scans = syntheticSweeps(3, 6);
    const TestMessages readings = readingMessages(syntheticReadings(2), wire);
    std::vector<std::pair<std::string, TestMessages>> bags;
    bags.emplace_back("clouds", merged(sweepMessages(scans, {}, wire), readings));
    CloudStyle style;
    style.time_name = "timestamp";
    style.time_type = "float64";
    style.time_unit = 1e9;
    style.absolute = true;
    style.rows = 2;
    style.with_holes = true;
    style.big_endian_data = true;
    bags.emplace_back("absolute", merged(sweepMessages(scans, style, wire), readings));
    TestMessages livox;
    for (const Scan& scan : scans)
        livox.push_back(
            {"/livox/lidar", "livox_ros_driver2/CustomMsg", arrivalOf(scan),
             livoxMessage(scan, wire)});
    bags.emplace_back("livox", merged(livox, readings));
    const Packets velodyne = velodynePackets(velodyne::Model::Vlp16, 4, 35900);
    bags.emplace_back(
        "velodyne", TestMessages{
                        {"/packets", "velodyne_msgs/VelodyneScan", kBagStart,
                         packetMessage("velodyne_msgs/VelodyneScan", wire, velodyne)}});
    const Packets hesai = hesaiPackets(formatOf(hesai::Model::Xt32), 4);
    for (const std::string type : {"pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets"})
        bags.emplace_back(
            type.substr(0, 6),
            TestMessages{{"/packets", type, kBagStart, packetMessage(type, wire, hesai)}});
    TestMessages ouster;
    const OusterSimulator sensor;
    ouster.push_back(
        {"/ouster/metadata", "std_msgs/String", kBagStart,
         [&]
         {
             WireWriter out(wire);
             out.text(sensor.description().dump());
             return out.message();
         }()});
    for (const Blob& packet : ousterPackets(sensor))
    {
        WireWriter out(wire);
        out.bytes(packet);
        ouster.push_back(
            {packet.size() == 48 ? "/ouster/imu_packets" : "/ouster/lidar_packets",
             "ouster_ros/PacketMsg", kBagStart, out.message()});
    }
    bags.emplace_back("ouster", ouster);
    return bags;
}

void addBagSeeds(const Seeds& seeds)
{
    for (const auto& [name, messages] : bagsOf(TestWire::Ros1))
        for (const std::string compression : {"", "bz2", "lz4"})
            if (compression.empty() || name == "clouds")
                seeds.add(
                    "ros1_bag", name + compression, Ros1Writer::bag(messages, {compression, 8}));
    seeds.add(
        "ros1_bag", "open", Ros1Writer::bag(bagsOf(TestWire::Ros1).front().second, {"", 8, false}));
    for (const auto& [name, messages] : bagsOf(TestWire::Cdr))
    {
        for (const std::string compression : {"", "lz4", "zstd"})
            if (compression.empty() || name == "clouds")
                seeds.add("mcap", name + compression, McapWriter::file(messages, {compression, 8}));
        std::filesystem::remove(seeds.file("sqlite3_bag", name));
        writeSqlite3Bag(seeds.file("sqlite3_bag", name), messages);
    }
    seeds.add(
        "mcap", "bare", McapWriter::file(bagsOf(TestWire::Cdr).front().second, {"", 0, false}));
    for (const char* part : {"a_0.mcap", "a_1.mcap"})
        seeds.add(
            "bag_folder", part,
            std::string("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
                        "  relative_file_paths:\n    - ") +
                part + "\n");
}

void addMessageSeeds(const Seeds& seeds)
{
    for (const auto wire : {TestWire::Cdr, TestWire::CdrBigEndian, TestWire::Ros1})
        for (const auto& [name, messages] : bagsOf(wire))
        {
            std::vector<std::string> pieces;
            for (const TestMessage& m : messages)
            {
                // As messages.cpp tells them apart.
                int kind = 0;
                if (m.type == "std_msgs/String") continue;
                if (m.type == "livox_ros_driver2/CustomMsg") kind = 1;
                if (m.type == "sensor_msgs/Imu") kind = 2;
                if (m.type == "velodyne_msgs/VelodyneScan") kind = 5;
                if (m.type == "pandar_msgs/PandarScan") kind = 6;
                if (m.type == "nebula_msgs/NebulaPackets") kind = 7;
                if (m.type == "ouster_ros/PacketMsg") kind = 3;
                pieces.emplace_back(
                    1, static_cast<char>(2 * kind + (wire == TestWire::Ros1 ? 1 : 0)));
                pieces.back().append(m.data.begin(), m.data.end());
            }
            seeds.add(
                "messages", name + "_" + std::to_string(static_cast<int>(wire)),
                '\0' + joinPieces(pieces));
        }
}

void addKittiSeeds(const Seeds& seeds)
{
    const Time t = 1'700'000'000'000'000'000;
    const std::string stamps = dateText(t) + "\n" + dateText(t + 100'000'000) + "\n";
    const std::string ends = dateText(t + 100'000'000) + "\n" + dateText(t + 200'000'000) + "\n";
    std::string oxts;
    for (int i = 0; i < 30; i++) oxts += std::to_string(0.5 * i) + " ";
    const auto scan = syntheticSweeps(1, 6).front();
    std::string points, text;
    for (const LidarPoint& p : scan.points)
    {
        const float values[] = {p.position.x(), p.position.y(), p.position.z(), p.intensity / 255};
        points.append(reinterpret_cast<const char*>(values), sizeof values);
        for (const float v : values) text += std::to_string(v) + " ";
        text += "\n";
    }
    const std::string camera = "image_00: 1 0 0 1 0 1 0 2 0 0 1 3\n";
    using Pieces = std::vector<std::string>;
    seeds.add(
        "kitti_drive", "raw",
        '\0' + joinPieces(Pieces{
                   stamps, ends, "R: 0 -1 0 1 0 0 0 0 1\nT: -0.8 0.3 -0.7\n", stamps, oxts, points,
                   text}));
    seeds.add(
        "kitti_drive", "360",
        '\1' + joinPieces(Pieces{
                   stamps, camera, "1 0 0 1 0 1 0 2 0 0 1 3\n", stamps, oxts, points, points}));
    seeds.add("kitti_drive", "odometry", '\2' + joinPieces(Pieces{"0\n0.1\n", points, points}));
}
}  // namespace

void addImportSeeds(const Seeds& seeds)
{
    addPacketSeeds(seeds);
    addBagSeeds(seeds);
    addMessageSeeds(seeds);
    addKittiSeeds(seeds);
}
}  // namespace taut::fuzz
