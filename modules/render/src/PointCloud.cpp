#include "taut/render/PointCloud.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "taut/core/VoxelSet.h"

namespace taut
{
namespace
{
PointCloud onePerVoxel(const PointCloud& points, double size)
{
    const auto inverse_size = static_cast<float>(1 / size);
    VoxelSet taken;
    PointCloud kept;
    for (const auto& point : points)
        if (taken.insert(voxelKey(point, inverse_size))) kept.push_back(point);
    return kept;
}

/** Length of the diagonal of the box in which all but 1 % at each end of each axis lie. */
double robustDiagonal(const PointCloud& points)
{
    Vector3d size;
    std::vector<double> values(points.size());
    for (int i = 0; i < 3; ++i)
    {
        std::transform(
            points.begin(), points.end(), values.begin(),
            [i](const Eigen::Vector3f& p) { return static_cast<double>(p[i]); });
        size[i] = robustSpan(values, 0.01).size();
    }
    return size.norm();
}
}  // namespace

Span robustSpan(std::vector<double>& values, double share_left_out)
{
    if (values.empty()) return {};
    const auto skip = static_cast<std::ptrdiff_t>(
        std::floor(share_left_out * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + skip, values.end());
    const double low = values[static_cast<std::size_t>(skip)];
    std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
    return {low, *(values.end() - 1 - skip)};
}

PointCloud finitePoints(const PointCloud& points)
{
    PointCloud kept;
    kept.reserve(points.size());
    std::copy_if(
        points.begin(), points.end(), std::back_inserter(kept),
        [](const Eigen::Vector3f& p) { return p.allFinite(); });
    return kept;
}

PointCloud thinned(const PointCloud& points, std::size_t max_points)
{
    if (points.size() <= max_points) return points;
    // Points lie on surfaces: their number falls with the square of the voxel's size.
    double size = std::max(1e-3, robustDiagonal(points) / 2000);
    PointCloud kept = onePerVoxel(points, size);
    while (kept.size() > max_points)
    {
        const double excess = static_cast<double>(kept.size()) / static_cast<double>(max_points);
        size *= std::clamp(std::sqrt(excess), 1.05, 2.0);
        kept = onePerVoxel(kept, size);
    }
    return kept;
}

PointCloud withoutStrays(const PointCloud& points)
{
    constexpr double kStray = 0.05;
    const auto inverse_size = static_cast<float>(48 / std::max(1e-3, robustDiagonal(points)));
    tsl::robin_map<std::uint64_t, int, VoxelHash> counts;
    for (const auto& point : points) ++counts[voxelKey(point, inverse_size)];

    std::vector<int> company;
    company.reserve(points.size());
    for (const auto& point : points) company.push_back(counts.at(voxelKey(point, inverse_size)));
    if (points.empty()) return {};
    std::vector<int> sorted = company;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    PointCloud kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (company[i] >= kStray * *middle) kept.push_back(points[i]);
    return kept;
}

double meanSpacing(const PointCloud& points)
{
    if (points.size() < 2) return 0;
    constexpr double kEnough =
        6;  // points in a voxel, for its occupied share of space to be a surface
    const auto count = static_cast<double>(points.size());
    double size = std::max(1e-3, robustDiagonal(points) / 512);
    PointCloud occupied = onePerVoxel(points, size);
    while (count < kEnough * static_cast<double>(occupied.size()) && occupied.size() > 8)
    {
        size *= 2;
        occupied = onePerVoxel(occupied, size);
    }
    return size * std::sqrt(static_cast<double>(occupied.size()) / count);
}
}  // namespace taut
