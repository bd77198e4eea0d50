#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "taut/packets/velodyne/PacketWriter.h"

namespace taut::test
{
struct PcapPacket
{
    Time t;
    velodyne::Packet bytes;
};

/** The Velodyne data packets (UDP payloads of 1206 bytes) of a classic little-endian pcap file with
 * Ethernet frames. Enough for the recordings of the tests. */
inline std::vector<PcapPacket> readVelodynePcap(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const auto u32 = [&file]
    {
        std::array<unsigned char, 4> b{};
        file.read(reinterpret_cast<char*>(b.data()), 4);
        return static_cast<std::uint32_t>(b[0] | b[1] << 8 | b[2] << 16) |
               static_cast<std::uint32_t>(b[3]) << 24;
    };
    if (u32() != 0xa1b2c3d4) throw std::runtime_error(path + " is no classic pcap file");
    file.seekg(24);
    constexpr std::size_t kHeaders = 14 + 20 + 8;  // Ethernet, IPv4, UDP
    std::vector<PcapPacket> packets;
    std::vector<char> frame;
    while (true)
    {
        const Time seconds = u32(), microseconds = u32();
        frame.resize(u32());
        u32();
        if (!file.read(frame.data(), static_cast<std::streamsize>(frame.size()))) break;
        if (frame.size() != kHeaders + velodyne::kPacketBytes) continue;
        PcapPacket packet;
        packet.t = seconds * 1'000'000'000 + microseconds * 1000;
        std::copy(frame.begin() + kHeaders, frame.end(), packet.bytes.begin());
        packets.push_back(packet);
    }
    return packets;
}
}  // namespace taut::test
