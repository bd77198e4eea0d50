#pragma once

#include "taut/core/Map.h"
#include "taut/map/VoxelForest.h"

namespace taut
{
/** The map of LOAM (Zhang and Singh, "LOAM: Lidar Odometry and Mapping in Real-time", RSS 2014,
 * section VI; the paper's way): edge points and planar points, each thinned by voxels and searched
 * by kd-trees.
 *
 * A query of kind Edge is matched with a line through its nearest edge points, any other with a
 * plane through its nearest planar points; points of kind Any are inserted as planar. The fit is by
 * the eigenvalues of the neighbours' scatter, about their mean. Its sigma is the scatter across it,
 * with what this leaves uncertain at the query. */
class KdTreeMap : public Map
{
    DEFINE_MRPT_OBJECT(KdTreeMap, taut)
 public:
    struct Config
    {
        double edge_voxel = 0.2;       //!< edge of a voxel for edge points [m]
        double plane_voxel = 0.4;      //!< edge of a voxel for planar points [m]
        int points_per_voxel = 20;     //!< a voxel keeps the mean of its first points
        int neighbours = 5;            //!< of a fit
        double gate = 1.0;             //!< of the neighbours of a query [m]
        double line_ratio = 3;         //!< of the eigenvalues of a line, along to across
        double line_tolerance = 0.2;   //!< largest distance of a neighbour from the line [m]
        double plane_tolerance = 0.2;  //!< largest distance of a neighbour from the plane [m]
        double window_radius = 100;    //!< half the edge of the box around the body [m]
    };

    KdTreeMap() = default;
    explicit KdTreeMap(const Config& config) { use(config); }

    /** Empties the map. */
    void configure(ConfigSection& section) override;

    void match(
        const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
        MapScratch& scratch, Executor& executor) const override;
    void insert(const std::vector<MapPoint>& points, Executor& executor) override;

    /** Forgets once the body has gone a tenth of the window's radius, not at every step. */
    void slide(const Vector3d& center_world) override;

    bool empty() const override { return size() == 0; }
    std::size_t size() const override { return edges_.size() + planes_.size(); }
    void clear() override;

 private:
    void use(const Config& config);
    Correspondence matchOne(const MapPoint& query) const;

    Config config_;
    VoxelForest edges_{config_.edge_voxel, config_.points_per_voxel};
    VoxelForest planes_{config_.plane_voxel, config_.points_per_voxel};
    bool has_center_ = false;
    Vector3d center_ = Vector3d::Zero();  // of the window
};
}  // namespace taut
