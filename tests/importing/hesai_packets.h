#pragma once

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "taut/packets/hesai/Decoder.h"

namespace taut::test
{
/** How a packet of a Hesai is laid out, written from its manual. */
struct HesaiFormat
{
    hesai::Model model;
    std::vector<std::uint8_t> header;
    std::size_t block_header, unit;  // bytes
    int blocks, lasers;
    std::size_t before_tail, size;         // bytes
    std::size_t mode_at, utc_at, time_at;  // in the tail
    int year_zero;
};

inline const std::vector<HesaiFormat> kHesaiFormats{
    {hesai::Model::Pandar40P, {}, 4, 3, 10, 40, 0, 1262, 14, 16, 10, 2000},
    {hesai::Model::Pandar64,
     {0xee, 0xff, 64, 6, 0, 4, 0, 0},
     2,
     3,
     6,
     64,
     0,
     1198,
     14,
     16,
     10,
     2000},
    {hesai::Model::Qt64,
     {0xee, 0xff, 3, 1, 0, 0, 64, 4, 1, 4, 2, 1},
     2,
     4,
     4,
     64,
     0,
     1072,
     16,
     18,
     12,
     1900},
    {hesai::Model::Qt128,
     {0xee, 0xff, 3, 2, 0, 0, 128, 2, 1, 4, 2, 0x1d},
     2,
     4,
     2,
     128,
     21,
     1127,
     12,
     15,
     21,
     1900},
    {hesai::Model::Xt16,
     {0xee, 0xff, 6, 1, 0, 0, 16, 8, 1, 4, 2, 1},
     2,
     4,
     8,
     16,
     0,
     568,
     10,
     13,
     19,
     1900},
    {hesai::Model::Xt32,
     {0xee, 0xff, 6, 1, 0, 0, 32, 8, 1, 4, 2, 1},
     2,
     4,
     8,
     32,
     0,
     1080,
     10,
     13,
     19,
     1900},
    {hesai::Model::Xt32M,
     {0xee, 0xff, 6, 1, 0, 0, 32, 6, 1, 4, 2, 1},
     2,
     4,
     6,
     32,
     0,
     820,
     10,
     13,
     19,
     1900}};

inline void PrintTo(const HesaiFormat& format, std::ostream* out)
{
    *out << hesai::nameOf(format.model);
}

inline const HesaiFormat& formatOf(hesai::Model model)
{
    return kHesaiFormats.at(static_cast<std::size_t>(model));
}

/** A data packet byte by byte: no return, return mode "strongest", 2023-06-15 12:34:56 and no
 * microseconds. */
class HesaiPacket
{
 public:
    static constexpr std::int64_t kSecond = 1'686'832'496;  //!< that date since 1970

    explicit HesaiPacket(hesai::Model model) : format_(formatOf(model)), bytes(format_.size)
    {
        std::copy(format_.header.begin(), format_.header.end(), bytes.begin());
        for (int block = 0; block < format_.blocks && format_.block_header == 4; block++)
        {
            bytes[blockAt(block)] = 0xff;
            bytes[blockAt(block) + 1] = 0xee;
        }
        setMode(0x37);
        setDate({static_cast<std::uint8_t>(2023 - format_.year_zero), 6, 15, 12, 34, 56});
    }

    void setAzimuth(int block, int azimuth)  //!< [0.01 deg]
    {
        put(blockAt(block) + format_.block_header - 2, azimuth, 2);
    }
    void setReturn(int block, int laser, int range, int reflectivity = 50)  //!< range in 4 mm
    {
        const std::size_t at =
            blockAt(block) + format_.block_header + static_cast<std::size_t>(laser) * format_.unit;
        put(at, range, 2);
        bytes[at + 2] = static_cast<std::uint8_t>(reflectivity);
    }
    void setMode(int mode) { bytes[tailAt() + format_.mode_at] = static_cast<std::uint8_t>(mode); }
    void setDate(const std::vector<std::uint8_t>& date)
    {
        std::copy(
            date.begin(), date.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(tailAt() + format_.utc_at));
    }
    void setMicroseconds(int us) { put(tailAt() + format_.time_at, us, 4); }

    std::size_t tailAt() const { return blockAt(format_.blocks) + format_.before_tail; }

 private:
    std::size_t blockAt(int block) const
    {
        const std::size_t block_bytes =
            format_.block_header + static_cast<std::size_t>(format_.lasers) * format_.unit;
        return format_.header.size() + static_cast<std::size_t>(block) * block_bytes;
    }
    void put(std::size_t at, int value, int count)
    {
        for (int i = 0; i < count; i++) bytes[at++] = static_cast<std::uint8_t>(value >> 8 * i);
    }

    HesaiFormat format_;

 public:
    std::vector<std::uint8_t> bytes;
};

/** Packets of an XT32 at 10 Hz whose lasers all see something at 10 m, from azimuth 0 on. */
inline std::vector<std::vector<std::uint8_t>> xt32Packets(int count)
{
    std::vector<std::vector<std::uint8_t>> packets;
    for (int i = 0; i < count; i++)
    {
        HesaiPacket packet(hesai::Model::Xt32);
        for (int block = 0; block < 8; block++)
        {
            packet.setAzimuth(block, (i * 8 + block) * 18 % 36000);
            for (int laser = 0; laser < 32; laser++) packet.setReturn(block, laser, 2500, laser);
        }
        packet.setMicroseconds(i * 400);
        packets.push_back(packet.bytes);
    }
    return packets;
}
}  // namespace taut::test
