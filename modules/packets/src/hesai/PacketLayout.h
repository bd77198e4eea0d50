#pragma once

#include <cstddef>
#include <cstdint>

#include "taut/packets/hesai/Model.h"

/** \file PacketLayout.h
 * Where the fields of a data packet are; all numbers little-endian. A packet is a header, blocks
 * (azimuth, a unit a laser), a tail, and more that is not read. */
namespace taut::hesai
{
struct PacketLayout
{
    std::size_t header;        // bytes
    std::size_t block_header;  // bytes; the last two are the azimuth
    std::size_t unit;          // bytes: range (2), reflectivity (1), more
    int blocks, lasers;
    std::size_t before_tail;             // bytes between blocks and tail that are always there
    std::size_t tail;                    // bytes
    std::size_t mode_at, utc_at, us_at;  // return mode, date, microseconds: in the tail
    std::size_t optional;                // bytes that may follow the tail

    std::size_t blockBytes() const
    {
        return block_header + static_cast<std::size_t>(lasers) * unit;
    }
    std::size_t blockAt(int block) const
    {
        return header + static_cast<std::size_t>(block) * blockBytes();
    }
    std::size_t unitAt(int block, int laser) const
    {
        return blockAt(block) + block_header + static_cast<std::size_t>(laser) * unit;
    }
};

inline constexpr std::size_t kSafetyBytes = 17;  // of a QT128, before its tail, if flagged

constexpr PacketLayout layoutOf(Model model)
{
    switch (model)
    {
        case Model::Pandar40P:
            return {0, 4, 3, 10, 40, 0, 22, 14, 16, 10, 4};
        case Model::Pandar64:
            return {8, 2, 3, 6, 64, 0, 22, 14, 16, 10, 4};
        case Model::Qt64:
            return {12, 2, 4, 4, 64, 0, 24, 16, 18, 12, 4};
        case Model::Qt128:
            return {12, 2, 4, 2, 128, 4, 26, 12, 15, 21, 4 + 4 + 32};
        case Model::Xt16:
            return {12, 2, 4, 8, 16, 0, 24, 10, 13, 19, 4};
        case Model::Xt32:
            break;
        case Model::Xt32M:
            return {12, 2, 4, 6, 32, 0, 24, 10, 13, 19, 4};
    }
    return {12, 2, 4, 8, 32, 0, 24, 10, 13, 19, 4};
}

/** Where the tail of a packet begins; the packet has its header at least. */
inline std::size_t tailAt(const std::uint8_t* packet, Model model)
{
    constexpr std::size_t kFlagsAt = 11;
    constexpr std::uint8_t kSafety = 4;
    const PacketLayout layout = layoutOf(model);
    const std::size_t tail = layout.blockAt(layout.blocks) + layout.before_tail;
    return model == Model::Qt128 && (packet[kFlagsAt] & kSafety) != 0 ? tail + kSafetyBytes : tail;
}
}  // namespace taut::hesai
