#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/NavState.h"
#include "taut/core/Scan.h"
#include "taut/core/ThinnedSample.h"
#include "taut/core/VoxelSet.h"
#include "taut/files/LasFile.h"
#include "taut/files/PlyFile.h"
#include "taut/map/OccupancyWorker.h"

namespace taut
{
struct MapExportConfig
{
    /** [m] one point of map.ply a voxel of this size; where 20 million are full, new points are
     * thinned twice as coarsely, again and again. */
    double point_spacing = 0.05;
    bool las = false;           //!< write map.las, too: the points of map.ply with their times
    double key_distance = 1.0;  //!< [m] or
    double key_angle = 0.35;    //!< [rad] or
    double key_time = 5.0;      //!< [s] from one key scan of the occupancy map to the next
    int key_points = 3000;      //!< rays of a key scan
    OccupancyMap::Config occupancy;

    void declare(ConfigSection& section);
};

/** Writes the map while the estimation runs: map.ply point by point, if asked for map.las with the
 * same points in the same order, and the occupancy octree from key scans in a thread of its own.
 * Keeps a bounded sample of the points for the pictures. */
class MapExport
{
 public:
    MapExport(const MapExportConfig& config, const std::string& folder);

    /** `raw`: the same points as they were measured, for their intensities and times; without
     * points: not known, and the time of the points is that of the state. */
    void add(
        const NavState& state, const std::vector<Vector3d>& points_world, const Scan& raw = {});

    /** Completes map.ply, map.las, map.ot and map.bt. Warning `las_range`: points that a LAS file
     * cannot hold. */
    void finish(const WarningSink& warn);

    /** After finish(): moves the files to another folder of the same file system. */
    void moveTo(const std::string& folder);

    /** After finish(): calls `visit(t, p_world)` for every point of map.ply with the time of its
     * scan, in the order of the scans. */
    void forPoints(const std::function<void(Time, const Vector3d&)>& visit) const;

    /** After finish(): moves the points that `gone` tells (world frame) from map.ply to
     * map_moved.ply, which is there only if it has points. map.las keeps none of them. Gives their
     * number. */
    std::size_t takeOut(const std::function<bool(const Vector3d&)>& gone);

    /** An even sample of the points of map.ply. */
    const std::vector<Eigen::Vector3f>& sample() const { return sample_.items(); }
    std::size_t points() const { return ply_.size() - taken_out_; }
    std::size_t keyScans() const { return key_scans_; }
    double occupancyResolution() const { return occupancy_resolution_; }

 private:
    void addPoint(const Vector3d& p, float intensity, Time t);
    bool isKey(const NavState& state) const;

    MapExportConfig config_;
    std::string folder_;
    PlyPointWriter ply_;
    std::optional<LasPointWriter> las_;
    VoxelSet voxels_;
    ThinnedSample<Eigen::Vector3f> sample_;
    double spacing_;  // [m] of new points: grows where the map is huge, so that memory does not
    OccupancyWorker occupancy_;
    std::vector<std::pair<Time, std::size_t>> scans_;  // and the number of points before each
    NavState last_key_;
    std::size_t key_scans_ = 0, taken_out_ = 0;
    double occupancy_resolution_ = 0;
};
}  // namespace taut
