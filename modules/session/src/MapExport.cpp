#include "taut/session/MapExport.h"

#include <cmath>
#include <filesystem>

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
    s.key("las", las, "write map.las, for surveyors' programs");
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
    if (config.las) las_.emplace(folder + "/map.las");
}

void MapExport::addPoint(const Vector3d& p, float intensity, Time t)
{
    if (!voxels_.insert(voxelKey(p, 1 / spacing_))) return;
    ply_.append({p.cast<float>(), intensity});
    if (las_) las_->append({p, intensity, t});
    sample_.add(p.cast<float>());
}

bool MapExport::isKey(const NavState& state) const
{
    if (key_scans_ == 0) return true;
    const Pose moved = last_key_.T_world_imu.inverse() * state.T_world_imu;
    return moved.p.norm() > config_.key_distance || logSO3(moved.R).norm() > config_.key_angle ||
           toSeconds(state.t - last_key_.t) > config_.key_time;
}

void MapExport::add(
    const NavState& state, const std::vector<Vector3d>& points_world, const Scan& raw)
{
    if (voxels_.size() > kMaxVoxels)
    {
        voxels_ = voxels_.coarser();
        spacing_ *= 2;
    }
    scans_.emplace_back(state.t, ply_.size());
    for (std::size_t i = 0; i < points_world.size(); i++)
    {
        const bool known = i < raw.points.size();
        const float intensity = known ? raw.points[i].intensity : 0;
        const Time t = known ? raw.timeOf(raw.points[i]) : state.t;
        addPoint(points_world[i], std::isfinite(intensity) ? intensity : 0, t);
    }
    ply_.flush();
    if (las_) las_->flush();
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
    if (las_)
    {
        las_->close();
        if (las_->size() < ply_.size() && warn)
            warn(
                {0, "las_range",
                 std::to_string(ply_.size() - las_->size()) +
                     " points of map.ply are not in map.las: they are more than 2147 km from the "
                     "origin, or more than the format counts"});
    }
    OccupancyMap& map = occupancy_.finish(warn);
    occupancy_resolution_ = map.resolution();
    map.writeOt(folder_ + "/map.ot");
    map.writeBt(folder_ + "/map.bt");
}

void MapExport::moveTo(const std::string& folder)
{
    for (const char* name : {"/map.ply", "/map.ot", "/map.bt"})
        std::filesystem::rename(folder_ + name, folder + name);
    if (las_) std::filesystem::rename(folder_ + "/map.las", folder + "/map.las");
    folder_ = folder;
}

void MapExport::forPoints(const std::function<void(Time, const Vector3d&)>& visit) const
{
    PlyReader points(folder_ + "/map.ply");
    std::vector<double> row;
    for (std::size_t i = 0; i < scans_.size(); i++)
    {
        const std::size_t end = i + 1 < scans_.size() ? scans_[i + 1].second : ply_.size();
        for (std::size_t k = scans_[i].second; k < end && points.next(row); k++)
            visit(scans_[i].first, {row[0], row[1], row[2]});
    }
}

std::size_t MapExport::takeOut(const std::function<bool(const Vector3d&)>& gone)
{
    const std::string whole = folder_ + "/map.ply", part = whole + ".part";
    PlyReader points(whole);
    PlyPointWriter stays(part), moved(folder_ + "/map_moved.ply");
    std::vector<bool> las_keeps;  // of each point in map.las
    for (std::vector<double> row; points.next(row);)
    {
        const Vector3d p(row[0], row[1], row[2]);
        const bool left = gone(p);
        (left ? moved : stays).append({p.cast<float>(), static_cast<float>(row[3])});
        if (las_ && LasPointWriter::fits(p.cast<float>())) las_keeps.push_back(!left);
    }
    stays.close();
    moved.close();
    taken_out_ = moved.size();
    if (taken_out_ == 0)
    {
        std::filesystem::remove(part);
        std::filesystem::remove(folder_ + "/map_moved.ply");
        return 0;
    }
    std::filesystem::rename(part, whole);
    if (las_)
        LasPointWriter::filter(folder_ + "/map.las", [&](std::size_t i) { return las_keeps[i]; });
    sample_.removeIf([&](const Eigen::Vector3f& p) { return gone(p.cast<double>()); });
    return taken_out_;
}
}  // namespace taut
