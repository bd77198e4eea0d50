#include "taut/map/VoxelForest.h"

#include <algorithm>

#include "KdTree.h"

namespace taut
{
namespace
{
constexpr std::size_t kGrowth = 2;  // a tree is at least this much larger than the next
}

VoxelForest::VoxelForest(double voxel_size, int max_points)
    : inverse_size_(1 / voxel_size), max_points_(max_points)
{
}

void VoxelForest::insert(const std::vector<Vector3d>& points)
{
    for (const Vector3d& point : points)
    {
        if (!point.allFinite()) continue;
        const std::uint64_t voxel = voxelKey(point, inverse_size_);
        const auto next = static_cast<std::uint32_t>(cells_.size());
        const auto [it, is_new] = index_.try_emplace(voxel, next);
        if (is_new)
        {
            cells_.push_back({point, 1, voxel});
            continue;
        }
        Cell& cell = cells_[it->second];
        if (cell.count < max_points_) cell.mean += (point - cell.mean) / ++cell.count;
    }
    plantNewCells();
}

void VoxelForest::plantNewCells()
{
    std::size_t first = trees_.empty() ? 0 : trees_.back()->first() + trees_.back()->size();
    if (first == cells_.size()) return;
    while (!trees_.empty() && trees_.back()->size() < kGrowth * (cells_.size() - first))
    {
        first = trees_.back()->first();
        trees_.pop_back();
    }
    std::vector<Eigen::Vector3f> points;
    points.reserve(cells_.size() - first);
    for (std::size_t i = first; i < cells_.size(); i++)
        points.emplace_back(cells_[i].mean.cast<float>());
    trees_.push_back(
        std::make_shared<const KdTree>(static_cast<std::uint32_t>(first), std::move(points)));
}

Neighbours VoxelForest::nearest(const Vector3d& query, std::size_t wanted, double radius) const
{
    Neighbours found;
    found.distances2.fill(static_cast<float>(radius * radius));
    const Eigen::Vector3f q = query.cast<float>();
    for (const auto& tree : trees_) tree->search(q, wanted, found);
    return found;
}

void VoxelForest::keepBox(const Vector3d& center, double radius)
{
    const auto outside = [&](const Cell& cell)
    { return (cell.mean - center).cwiseAbs().maxCoeff() > radius; };
    const auto kept = std::remove_if(cells_.begin(), cells_.end(), outside);
    if (kept == cells_.end()) return;
    cells_.erase(kept, cells_.end());
    index_.clear();
    trees_.clear();
    for (std::uint32_t i = 0; i < cells_.size(); i++) index_[cells_[i].voxel] = i;
    plantNewCells();
}

void VoxelForest::clear()
{
    cells_.clear();
    index_.clear();
    trees_.clear();
}
}  // namespace taut
