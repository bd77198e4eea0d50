#pragma once

#include <octomap/OcTreeKey.h>

#include <cstdint>

namespace taut
{
constexpr unsigned kTreeDepth = 16;  // of every octomap tree
constexpr int kMiddleKey = 32768;    // of the leaf at the origin

/** A key of octomap as one integer, for hash tables. */
inline std::uint64_t pack(std::uint16_t x, std::uint16_t y, std::uint16_t z)
{
    return std::uint64_t{x} | std::uint64_t{y} << 16 | std::uint64_t{z} << 32;
}

inline octomap::OcTreeKey unpack(std::uint64_t packed)
{
    return {
        static_cast<std::uint16_t>(packed), static_cast<std::uint16_t>(packed >> 16),
        static_cast<std::uint16_t>(packed >> 32)};
}

/** Depth of the nodes of a level: 0 are the leaves. */
inline unsigned depthOf(int level)
{
    return kTreeDepth - static_cast<unsigned>(level);
}
}  // namespace taut
