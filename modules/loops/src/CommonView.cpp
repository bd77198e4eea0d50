#include "taut/loops/CommonView.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "taut/core/Voxel.h"

namespace taut
{
namespace
{
constexpr double kMargin = 0.1;         // [m] and
constexpr double kMarginShare = 0.02;   // of the range, before the end of a ray
constexpr double kCell = 0.026;         // [rad] of a range image
constexpr double kGrazing = 0.1;        // cosine: a surface that is seen so tells nothing
constexpr double kInverseCell = 2;      // [1/m]
constexpr double kConflictShare = 0.6;  // of the points of a cell
}  // namespace

Visibility visibilityOf(const Vector3d& point, const Vector3d& normal, const KeyScan& key)
{
    const std::optional<double> nearest = key.image.nearestAround(point);
    if (!nearest) return Visibility::Unknown;
    const double range = point.norm();
    const double cosine = std::abs(normal.dot(point)) / range;
    const double margin = kMargin + kMarginShare * range + key.blur;
    const double slanted = margin + kCell * range / std::max(cosine, kGrazing);
    if (std::abs(range - *nearest) < margin) return Visibility::Surface;
    if (range >= *nearest - slanted) return Visibility::Unknown;
    return cosine > kGrazing ? Visibility::Free : Visibility::Past;
}

std::vector<Visibility> visibilityOf(
    const std::vector<MapPoint>& points, const std::vector<Vector3d>& normals,
    const Pose& T_submap_other, const Submap& submap)
{
    std::vector<Visibility> seen(points.size(), Visibility::Unknown);
    for (const KeyScan& key : submap.key_scans)
    {
        const Pose T_sensor_other = key.T_submap_sensor.inverse() * T_submap_other;
        for (std::size_t i = 0; i < points.size(); i++)
        {
            if (seen[i] == Visibility::Surface) continue;
            const Visibility by_key = visibilityOf(
                T_sensor_other * points[i].position, T_sensor_other.R * normals[i], key);
            if (by_key == Visibility::Surface || by_key == Visibility::Free) seen[i] = by_key;
        }
    }
    return seen;
}

CommonView commonView(
    const std::vector<MapPoint>& points, const Pose& T_submap_other,
    const std::vector<Visibility>& visibility, const std::vector<bool>& on_surface)
{
    struct Cell
    {
        int points = 0, free = 0;
    };
    CommonView view;
    std::map<std::uint64_t, Cell> cells;
    std::array<int, 8> sectors{};
    for (std::size_t i = 0; i < points.size(); i++)
    {
        if (visibility[i] == Visibility::Unknown && !on_surface[i]) continue;
        view.points++;
        const Vector3d p = T_submap_other * points[i].position;
        Cell& cell = cells[voxelKey(p, kInverseCell)];
        cell.points++;
        if (on_surface[i])
        {
            view.on_surface++;
            const double turn = std::atan2(p.y(), p.x()) / (2 * M_PI) + 0.5;
            sectors[std::min<std::size_t>(static_cast<std::size_t>(turn * 8), 7)]++;
        }
        else if (visibility[i] == Visibility::Free)
        {
            cell.free++;
        }
    }
    view.cells = static_cast<int>(cells.size());
    for (const auto& [key, cell] : cells)
        if (cell.free > kConflictShare * cell.points) view.conflicts++;
    for (const int in_sector : sectors)
        if (8 * 10 * in_sector > view.on_surface && in_sector > 0) view.sectors++;
    return view;
}
}  // namespace taut
