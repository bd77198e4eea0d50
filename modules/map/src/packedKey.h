#pragma once

#include <octomap/OcTreeKey.h>

#include <cstdint>

#include "taut/core/Voxel.h"
#include "taut/map/StatisticsTree.h"

namespace taut
{
constexpr int kMiddleKey = 1 << (StatisticsTree::kDepth - 1);  // of the leaf at the origin

/** A key of octomap as one integer, for hash tables. */
inline std::uint64_t pack(std::uint16_t x, std::uint16_t y, std::uint16_t z)
{
    return packVoxel(x, y, z);
}

inline octomap::OcTreeKey unpack(std::uint64_t packed)
{
    return {
        static_cast<std::uint16_t>(packed >> 42), static_cast<std::uint16_t>(packed >> 21),
        static_cast<std::uint16_t>(packed)};
}

/** Depth of the nodes of a level: 0 are the leaves. */
inline unsigned depthOf(int level)
{
    return StatisticsTree::kDepth - static_cast<unsigned>(level);
}
}  // namespace taut
