#pragma once

#include <tsl/robin_map.h>

#include <cstddef>
#include <cstdint>

#include "taut/core/Voxel.h"

namespace taut
{
/** A set of voxels, named by keys of 21 bits a coordinate as voxelKey() makes them. 4 x 4 x 4
 * voxels share an entry, a bit each: points and rays stay within such a block for a while, and a
 * surface takes a sixth of the memory that a set of keys would take. */
class VoxelSet
{
 public:
    /** True if the voxel was not in the set. */
    bool insert(std::uint64_t voxel)
    {
        std::uint64_t& bits = blocks_[blockOf(voxel)];
        const std::uint64_t bit = bitOf(voxel);
        if ((bits & bit) != 0) return false;
        bits |= bit;
        size_++;
        return true;
    }

    bool contains(std::uint64_t voxel) const
    {
        const auto it = blocks_.find(blockOf(voxel));
        return it != blocks_.end() && (it->second & bitOf(voxel)) != 0;
    }

    void erase(std::uint64_t voxel)
    {
        const auto it = blocks_.find(blockOf(voxel));
        if (it == blocks_.end() || (it->second & bitOf(voxel)) == 0) return;
        it.value() &= ~bitOf(voxel);
        size_--;
    }

    /** Number of voxels in the set. */
    std::size_t size() const { return size_; }

    /** The voxels of twice the edge that hold those of the set: keys as voxelKey() makes them with
     * half the inverse size. */
    VoxelSet coarser() const
    {
        VoxelSet parents;
        for (const auto& [block, bits] : blocks_)
            for (unsigned bit = 0; bit < 64; bit++)
                if ((bits >> bit & 1) != 0)
                    parents.insert(parentOf(
                        block | (bit & 3u) | std::uint64_t{bit >> 2 & 3u} << 21 |
                        std::uint64_t{bit >> 4} << 42));
        return parents;
    }

    void clear()
    {
        blocks_.clear();
        size_ = 0;
    }

 private:
    static constexpr std::uint64_t kWithin = 3 | 3ull << 21 | 3ull << 42;

    /** Half of each coordinate, which is counted from 2^20. */
    static std::uint64_t parentOf(std::uint64_t voxel)
    {
        std::uint64_t parent = 0;
        for (const unsigned at : {0u, 21u, 42u})
            parent |= ((voxel >> at & 0x1fffff) / 2 + (1u << 19)) << at;
        return parent;
    }
    static std::uint64_t blockOf(std::uint64_t voxel) { return voxel & ~kWithin; }
    static std::uint64_t bitOf(std::uint64_t voxel)
    {
        return 1ull << ((voxel & 3) | (voxel >> 19 & 3 << 2) | (voxel >> 38 & 3 << 4));
    }

    tsl::robin_map<std::uint64_t, std::uint64_t, VoxelHash> blocks_;
    std::size_t size_ = 0;
};
}  // namespace taut
