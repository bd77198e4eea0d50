#include "PointSelection.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "taut/core/Voxel.h"

namespace taut
{
namespace
{
/** A number as good as random that belongs to the point, wherever it stands in the scan. */
std::uint64_t lotOf(const LidarPoint& point)
{
    std::uint32_t bits[3];
    std::memcpy(bits, point.position.data(), sizeof(bits));
    const auto time = static_cast<std::uint32_t>(point.offset);
    const auto first = static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
    const auto second = static_cast<std::uint64_t>(bits[2]) << 32 | time;
    return mixBits(first ^ mixBits(second + 0x9e3779b97f4a7c15u));
}

struct Drawn
{
    std::uint64_t lot;
    std::uint32_t index;
};
}  // namespace

PointIndices finitePoints(const Scan& scan)
{
    PointIndices indices;
    indices.reserve(scan.points.size());
    for (std::uint32_t i = 0; i < scan.points.size(); i++)
        if (scan.points[i].position.allFinite()) indices.push_back(i);
    return indices;
}

PointIndices onePerVoxel(const Scan& scan, const PointIndices& candidates, double voxel_size)
{
    const float inverse = static_cast<float>(1 / voxel_size);
    tsl::robin_map<std::uint64_t, Drawn, VoxelHash> drawn;
    drawn.reserve(candidates.size() / 4);
    for (const std::uint32_t i : candidates)
    {
        const LidarPoint& point = scan.points[i];
        const Drawn mine{lotOf(point), i};
        const auto [it, is_new] = drawn.try_emplace(voxelKey(point.position, inverse), mine);
        if (!is_new && mine.lot < it->second.lot) it.value() = mine;
    }
    PointIndices kept;
    kept.reserve(drawn.size());
    for (const auto& [voxel, chosen] : drawn) kept.push_back(chosen.index);
    return kept;
}

PointIndices thinToAtMost(
    const Scan& scan, PointIndices candidates, double voxel_size, std::size_t max_points)
{
    if (max_points == 0) return {};
    while (candidates.size() > max_points)
    {
        // Points on surfaces become fewer with the square of the voxel's size.
        const double excess =
            static_cast<double>(candidates.size()) / static_cast<double>(max_points);
        voxel_size *= std::max(1.1, std::sqrt(excess));
        candidates = onePerVoxel(scan, candidates, voxel_size);
    }
    return candidates;
}

void addFeature(const Scan& scan, std::uint32_t index, FeatureKind kind, Features& features)
{
    const LidarPoint& point = scan.points[index];
    features.points.push_back({point.position, point.offset, kind});
}

void sortFeatures(Features& features)
{
    const auto key = [](const Feature& f)
    { return std::make_tuple(f.offset, f.kind, f.position.x(), f.position.y(), f.position.z()); };
    std::sort(
        features.points.begin(), features.points.end(),
        [&](const Feature& a, const Feature& b) { return key(a) < key(b); });
}

bool warnIfSparse(
    const Scan& scan, std::size_t points, std::size_t min_points, const WarningSink& warn)
{
    if (points > 0 && points >= min_points) return false;
    if (warn)
        warn(
            {scan.end, "sparse_scan",
             "the scan has " + std::to_string(points) + " points, fewer than " +
                 std::to_string(std::max<std::size_t>(min_points, 1))});
    return true;
}
}  // namespace taut
