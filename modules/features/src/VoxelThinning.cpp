#include "taut/features/VoxelThinning.h"

#include "PointSelection.h"

IMPLEMENTS_MRPT_OBJECT(VoxelThinning, taut::FeatureExtractor, taut)

namespace taut
{
void VoxelThinning::configure(ConfigSection& section)
{
    section.key("voxel_size", config_.voxel_size, {kSmallestVoxel, 1e3}, "m, edge of a voxel");
    section.key("min_points", config_.min_points, kNotNegative, "fewer kept: thin less");
    section.key("max_points", config_.max_points, {1, 1e9}, "more kept: thin more");
    if (config_.min_points > config_.max_points)
        throw ConfigError(section.path() + ": min_points exceeds max_points");
}

Features VoxelThinning::extract(const Scan& scan, const WarningSink& warn) const
{
    const PointIndices all = finitePoints(scan);
    const auto min_points = static_cast<std::size_t>(config_.min_points);
    warnIfSparse(scan, all.size(), min_points, warn);

    double voxel_size = config_.voxel_size;
    PointIndices kept = all;
    if (all.size() > min_points) kept = onePerVoxel(scan, all, voxel_size);
    while (kept.size() < min_points && kept.size() < all.size())
    {
        voxel_size /= 2;
        kept = voxel_size < kSmallestVoxel ? all : onePerVoxel(scan, all, voxel_size);
    }
    kept = thinToAtMost(
        scan, std::move(kept), voxel_size, static_cast<std::size_t>(config_.max_points));

    Features features;
    features.stamp = scan.stamp;
    features.points.reserve(kept.size());
    for (const std::uint32_t i : kept) addFeature(scan, i, FeatureKind::Any, features);
    sortFeatures(features);
    return features;
}
}  // namespace taut
