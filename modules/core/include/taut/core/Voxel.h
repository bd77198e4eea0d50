#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

/** \file Voxel.h
 * Cells of a regular grid named by one integer, for hash tables. */
namespace taut
{
/** Mixes the bits of an integer so that each depends on all (the finaliser of SplitMix64). */
constexpr std::uint64_t mixBits(std::uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/** The key of a voxel by its numbers along x, y and z, of which 21 bits count each. */
inline std::uint64_t packVoxel(std::uint64_t x, std::uint64_t y, std::uint64_t z)
{
    constexpr std::uint64_t bits = 0x1fffff;
    return (x & bits) << 42 | (y & bits) << 21 | (z & bits);
}

/** The voxel that holds a finite point, 21 bits a coordinate. `inverse_size` is 1 / edge [1/m].
 * Voxels that are 2^21 voxels apart along an axis share a key. */
template <class Scalar>
std::uint64_t voxelKey(const Eigen::Matrix<Scalar, 3, 1>& point, Scalar inverse_size)
{
    constexpr Scalar limit = (1 << 30) - (1 << 19);  // of what an integer names; no map is so large
    const auto number = [&](int axis)
    {
        const Scalar scaled = std::max(-limit, std::min(limit, point[axis] * inverse_size));
        auto cell =
            static_cast<std::int32_t>(scaled);  // towards zero; std::floor is 4 times slower
        cell -= scaled < static_cast<Scalar>(cell);
        return static_cast<std::uint64_t>(std::int64_t{cell} + (1 << 20));
    };
    return packVoxel(number(0), number(1), number(2));
}

/** Hash of a voxel's key for hash tables. */
struct VoxelHash
{
    std::size_t operator()(std::uint64_t key) const { return mixBits(key); }
};
}  // namespace taut
