#pragma once

#include "taut/core/FeatureExtractor.h"

namespace taut
{
/** Keeps one raw point per voxel of the IMU frame, for any LiDAR, with rings or without. The point
 * that stands for a voxel is drawn by a hash of its own bits: unlike the first in time or the one
 * closest to the centre it favours neither a part of the sweep nor a sign of the range noise, and
 * unlike a mean it has one time. All features are of kind Any.
 *
 * The size of the voxel adapts to the scan: halved until `min_points` are kept (or all are), grown
 * until at most `max_points` are. Points that are not finite are left out. A scan with fewer than
 * `min_points` points is used whole, with the warning "sparse_scan". The result does not depend on
 * the order of the points in the scan. */
class VoxelThinning : public FeatureExtractor
{
    DEFINE_MRPT_OBJECT(VoxelThinning, taut)
 public:
    struct Config
    {
        double voxel_size = 0.3;  //!< edge of a voxel to begin with [m]
        int min_points = 800;     //!< fewer kept: thin less
        int max_points = 2000;    //!< more kept: thin more
    };

    VoxelThinning() = default;
    explicit VoxelThinning(const Config& config) : config_(config) {}

    /** Throws ConfigError if min_points exceeds max_points. */
    void configure(ConfigSection& section) override;
    Features extract(const Scan& scan, const WarningSink& warn) const override;

 private:
    Config config_;
};
}  // namespace taut
