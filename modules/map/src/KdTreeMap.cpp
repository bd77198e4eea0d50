#include "taut/map/KdTreeMap.h"

#include <array>

#include "SurfaceFit.h"

IMPLEMENTS_MRPT_OBJECT(KdTreeMap, taut::Map, taut)

namespace taut
{
namespace
{
constexpr std::size_t kChunk = 64;     // queries
constexpr double kSlideShare = 0.1;    // of the window's radius
constexpr double kLeastSpread = 0.25;  // of planar points, in voxels; less is a row
}  // namespace

void KdTreeMap::configure(ConfigSection& section)
{
    Config c = config_;
    section.key("edge_voxel", c.edge_voxel, kPositive, "m, voxel of edge points");
    section.key("plane_voxel", c.plane_voxel, kPositive, "m, voxel of planar points");
    section.key("points_per_voxel", c.points_per_voxel, {1, 1e9}, "a voxel keeps their mean");
    section.key("neighbours", c.neighbours, {3, Neighbours::kMost}, "of a line or plane");
    section.key("gate", c.gate, kPositive, "m, furthest neighbour of a query");
    section.key("line_ratio", c.line_ratio, {1, 1e9}, "of eigenvalues, along to across");
    section.key("line_tolerance", c.line_tolerance, kPositive, "m, of all neighbours");
    section.key("plane_tolerance", c.plane_tolerance, kPositive, "m, of all neighbours");
    section.key("window_radius", c.window_radius, kPositive, "m, half the box around the body");
    use(c);
}

void KdTreeMap::use(const Config& config)
{
    config_ = config;
    clear();
}

void KdTreeMap::clear()
{
    edges_ = VoxelForest(config_.edge_voxel, config_.points_per_voxel);
    planes_ = VoxelForest(config_.plane_voxel, config_.points_per_voxel);
    has_center_ = false;
}

void KdTreeMap::insert(const std::vector<MapPoint>& points, Executor& /*executor*/)
{
    std::vector<Vector3d> edges, planes;
    for (const MapPoint& point : points)
        (point.kind == FeatureKind::Edge ? edges : planes).push_back(point.position);
    edges_.insert(edges);
    planes_.insert(planes);
}

void KdTreeMap::slide(const Vector3d& center_world)
{
    const double moved = (center_world - center_).cwiseAbs().maxCoeff();
    if (has_center_ && moved < kSlideShare * config_.window_radius) return;
    has_center_ = true;
    center_ = center_world;
    edges_.keepBox(center_, config_.window_radius);
    planes_.keepBox(center_, config_.window_radius);
}

void KdTreeMap::match(
    const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
    MapScratch& /*scratch*/, Executor& executor) const
{
    correspondences.assign(queries.size(), {});
    executor.forChunks(
        queries.size(), kChunk,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++) correspondences[i] = matchOne(queries[i]);
        });
}

Correspondence KdTreeMap::matchOne(const MapPoint& query) const
{
    if (!query.position.allFinite()) return {};
    const bool is_edge = query.kind == FeatureKind::Edge;
    const VoxelForest& forest = is_edge ? edges_ : planes_;
    const auto wanted = static_cast<std::size_t>(config_.neighbours);
    const Neighbours found = forest.nearest(query.position, wanted, config_.gate);
    if (found.count < wanted) return {};

    std::array<Vector3d, Neighbours::kMost> points;
    for (std::size_t i = 0; i < wanted; i++) points[i] = forest.mean(found.cells[i]);
    const SurfaceFit fit(points.data(), wanted);
    return is_edge
               ? fit.line(query.position, config_.line_ratio, config_.line_tolerance)
               : fit.plane(
                     query.position, kLeastSpread * config_.plane_voxel, config_.plane_tolerance);
}
}  // namespace taut
