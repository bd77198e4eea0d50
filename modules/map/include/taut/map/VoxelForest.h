#pragma once

#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Voxel.h"

namespace taut
{
class KdTree;

/** Up to eight nearest neighbours, by index of the cell, the nearest first. */
struct Neighbours
{
    static constexpr std::size_t kMost = 8;

    std::size_t count = 0;
    std::array<std::uint32_t, kMost> cells{};
    std::array<float, kMost> distances2{};  //!< [m^2]
};

/** Points thinned to one per voxel, the mean of the first few that fell in it, and searched by
 * kd-trees.
 *
 * A kd-tree cannot grow, so there are several (a logarithmic forest): new cells make a small tree,
 * and a tree that is not much larger than the one that follows is merged with it. A cell is built
 * into a tree at most about log(n) times, and there are about log(n) trees. Trees are immutable and
 * shared by copies.
 *
 * The search sees a cell where its mean was when its tree was built; what it returns are the means
 * of now. The difference is less than a voxel. */
class VoxelForest
{
 public:
    /** `voxel_size` is the edge of a voxel [m]; a mean is over at most `max_points` points. */
    explicit VoxelForest(double voxel_size = 0.4, int max_points = 20);

    /** Adds points, world frame; those not finite are left out. */
    void insert(const std::vector<Vector3d>& points);

    /** The `wanted` (at most 8) cells nearest to a finite query, no further than `radius` [m]. */
    Neighbours nearest(const Vector3d& query, std::size_t wanted, double radius) const;

    /** Mean of a cell [m]. */
    const Vector3d& mean(std::uint32_t cell) const { return cells_[cell].mean; }

    /** Forgets the cells whose mean is further than `radius` from the centre along any axis. */
    void keepBox(const Vector3d& center, double radius);

    std::size_t size() const { return cells_.size(); }
    void clear();

 private:
    struct Cell
    {
        Vector3d mean;
        int count;
        std::uint64_t voxel;
    };

    /** Makes a tree of the cells that are in none. */
    void plantNewCells();

    double inverse_size_;
    int max_points_;
    std::vector<Cell> cells_;
    tsl::robin_map<std::uint64_t, std::uint32_t, VoxelHash> index_;  // voxel to cell
    std::vector<std::shared_ptr<const KdTree>> trees_;               // of consecutive cells
};
}  // namespace taut
