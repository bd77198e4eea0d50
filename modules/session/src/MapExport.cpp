#include "taut/session/MapExport.h"

namespace taut
{
namespace
{
constexpr std::size_t kMaxVoxels = 20'000'000;  // then new points are thinned twice as coarsely
constexpr std::size_t kMaxSample = 1'000'000;
}  // namespace

void MapExportConfig::declare(ConfigSection& s)
{
    s.key("point_spacing", point_spacing, kPositive, "m, one point of map.ply a voxel");
    s.key("key_distance", key_distance, kPositive, "m between key scans of the occupancy map, or");
    s.key("key_angle", key_angle, kPositive, "rad, or");
    s.key("key_time", key_time, kPositive, "s");
    s.key("key_points", key_points, {1, 1e6}, "rays of a key scan");
    occupancy.declare(s.section("occupancy"));
}

MapExport::MapExport(const MapExportConfig& config, const std::string& folder)
    : config_(config),
      folder_(folder),
      ply_(folder + "/map.ply"),
      sample_(kMaxSample),
      spacing_(config.point_spacing),
      occupancy_(config.occupancy)
{
}

void MapExport::addPoint(const Vector3d& p)
{
    if (!voxels_.insert(voxelKey(p, 1 / spacing_))) return;
    ply_.append({p.cast<float>(), 0});
    sample_.add(p.cast<float>());
}

bool MapExport::isKey(const NavState& state) const
{
    if (key_scans_ == 0) return true;
    const Pose moved = last_key_.T_world_imu.inverse() * state.T_world_imu;
    return moved.p.norm() > config_.key_distance || logSO3(moved.R).norm() > config_.key_angle ||
           toSeconds(state.t - last_key_.t) > config_.key_time;
}

void MapExport::add(const NavState& state, const std::vector<Vector3d>& points_world)
{
    if (voxels_.size() > kMaxVoxels)
    {
        voxels_ = voxels_.coarser();
        spacing_ *= 2;
    }
    for (const Vector3d& p : points_world) addPoint(p);
    ply_.flush();
    if (points_world.empty() || !isKey(state)) return;
    last_key_ = state;
    key_scans_++;
    const std::size_t stride =
        1 + points_world.size() / static_cast<std::size_t>(config_.key_points);
    std::vector<Vector3d> rays;
    for (std::size_t i = 0; i < points_world.size(); i += stride) rays.push_back(points_world[i]);
    occupancy_.submit(state.t, state.T_world_imu.p, std::move(rays));
}

void MapExport::finish(const WarningSink& warn)
{
    ply_.close();
    OccupancyMap& map = occupancy_.finish(warn);
    occupancy_resolution_ = map.resolution();
    map.writeOt(folder_ + "/map.ot");
    map.writeBt(folder_ + "/map.bt");
}
}  // namespace taut
