#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/Features.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"

/** \file PointSelection.h
 * What the extractors share: choosing points of a scan by index. */
namespace taut
{
using PointIndices = std::vector<std::uint32_t>;

inline constexpr double kSmallestVoxel = 1e-3;  //!< [m]; a smaller one is the point itself

/** The points whose coordinates are all finite. */
PointIndices finitePoints(const Scan& scan);

/** Of the candidates, which must be finite, one per voxel of edge `voxel_size` [m], drawn by a hash
 * of the point's own bits. The order of the result is not specified. */
PointIndices onePerVoxel(const Scan& scan, const PointIndices& candidates, double voxel_size);

/** Thins the candidates by ever larger voxels, from `voxel_size`, until at most `max_points` are
 * left. */
PointIndices thinToAtMost(
    const Scan& scan, PointIndices candidates, double voxel_size, std::size_t max_points);

/** Appends a point of the scan. */
void addFeature(const Scan& scan, std::uint32_t index, FeatureKind kind, Features& features);

/** Order of time; ties are broken by kind and position, so that it does not depend on the order in
 * which the points came. */
void sortFeatures(Features& features);

/** Warns ("sparse_scan") of a scan that has fewer points than `min_points`, or none; returns
 * whether. */
bool warnIfSparse(
    const Scan& scan, std::size_t points, std::size_t min_points, const WarningSink& warn);
}  // namespace taut
