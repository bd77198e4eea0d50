#pragma once

#include "taut/core/FeatureExtractor.h"

namespace taut
{
/** Edge and planar features by the curvature along each ring, as in LOAM (Zhang and Singh, "LOAM:
 * Lidar Odometry and Mapping in Real-time", RSS 2014, section V-A), for LiDARs with rings.
 *
 * A point is compared with the means of its 5 neighbours on either side in the order of time. Where
 * the points are dense, each neighbour is the mean of several, so that the neighbours are about
 * `neighbour_spacing` apart at any resolution: the curvature of a wall is then not that of its
 * noise. The curvature is scale-free: tan(turn / 2) for a ring that turns by that angle: 0 on a
 * plane, 1 at a right angle. Points behind an occlusion, at gaps, and on surfaces almost parallel
 * to the beam are left out; the nearer rim of an occlusion is an edge.
 *
 * Each ring is cut in sectors, so that features come from all around; each gives its most and least
 * curved points, with a distance kept between them. Further flat points are added, thinned by
 * voxels.
 *
 * Fewer than `min_points` features: sectors give more and voxels get smaller, with the warning
 * "few_features"; where this is not enough the whole scan is used, its other points as
 * FeatureKind::Any. A scan with fewer than `min_points` points also gets the warning "sparse_scan".
 */
class CurvatureExtractor : public FeatureExtractor
{
    DEFINE_MRPT_OBJECT(CurvatureExtractor, taut)
 public:
    struct Config
    {
        int neighbours = 5;               //!< on either side of a point
        double neighbour_spacing = 0.06;  //!< least distance between neighbours [m]
        double range_noise = 0.02;        //!< standard deviation of a range [m]
        double edge_curvature = 0.3;      //!< an edge has more
        double plane_curvature = 0.1;     //!< a plane has less
        double occlusion_step = 0.1;      //!< step in range that is no surface [m]
        double max_incidence = 80;        //!< between beam and normal [deg]
        int sectors = 6;                  //!< of a ring
        int edges_per_sector = 4;
        int planes_per_sector = 8;
        double feature_distance = 0.3;  //!< between features of one kind on a ring, at least [m]
        double flat_voxel = 0.4;        //!< one more flat point per voxel [m]; 0 for no more points
        int min_points = 300;           //!< fewer features: thin less
        int max_points = 5000;          //!< more features: thin more
    };

    CurvatureExtractor() = default;
    explicit CurvatureExtractor(const Config& config) : config_(config) {}

    /** Throws ConfigError if min_points exceeds max_points, or the curvature of planes that of
     * edges. */
    void configure(ConfigSection& section) override;

    /** Throws std::runtime_error for a scan without rings, or a point on a ring that it does not
     * have. */
    Features extract(const Scan& scan, const WarningSink& warn) const override;

 private:
    Config config_;
};
}  // namespace taut
