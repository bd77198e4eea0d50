#pragma once

#include <cstddef>
#include <cstdint>

#include "taut/packets/velodyne/Decoder.h"

/** \file PacketLayout.h
 * Offsets of the fields of a data packet; all numbers little-endian. */
namespace taut::velodyne
{
inline constexpr std::uint16_t kBlockFlag = 0xeeff;
inline constexpr std::uint16_t kBankFlags[] = {kBlockFlag, 0xddff, 0xccff, 0xbbff};
inline constexpr std::size_t kReturnBytes = 3;       // range (2), intensity (1)
inline constexpr std::size_t kBlockHeaderBytes = 4;  // flag (2), azimuth (2)
inline constexpr std::size_t kBlockBytes = kBlockHeaderBytes + kReturnsPerBlock * kReturnBytes;
inline constexpr std::size_t kTimeAt = kBlocks * kBlockBytes;
inline constexpr std::size_t kModeAt = kTimeAt + 4;
inline constexpr std::size_t kModelAt = kTimeAt + 5;
static_assert(kModelAt + 1 == kPacketBytes);

inline constexpr int kFullTurn = 36000;               // [0.01 deg]
inline constexpr std::int64_t kHour = 3'600'000'000;  // [us]

constexpr std::size_t blockAt(int block)
{
    return static_cast<std::size_t>(block) * kBlockBytes;
}
constexpr std::size_t returnAt(int block, int slot)
{
    return blockAt(block) + kBlockHeaderBytes + static_cast<std::size_t>(slot) * kReturnBytes;
}
inline std::uint16_t read16(const std::uint8_t* bytes)
{
    return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}
inline void write16(std::uint8_t* bytes, std::uint16_t value)
{
    bytes[0] = static_cast<std::uint8_t>(value & 0xff);
    bytes[1] = static_cast<std::uint8_t>(value >> 8);
}
inline std::uint32_t read32(const std::uint8_t* bytes)
{
    return read16(bytes) | static_cast<std::uint32_t>(read16(bytes + 2)) << 16;
}
inline void write32(std::uint8_t* bytes, std::uint32_t value)
{
    write16(bytes, static_cast<std::uint16_t>(value & 0xffff));
    write16(bytes + 2, static_cast<std::uint16_t>(value >> 16));
}
}  // namespace taut::velodyne
