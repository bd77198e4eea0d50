#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "taut/core/Geometry.h"

/** \file PointCloud.h
 * Which points of a map a picture shows. All functions keep the order of the points and depend on
 * nothing but their arguments. */
namespace taut
{
using PointCloud = std::vector<Eigen::Vector3f>;  //!< world frame [m]

/** Smallest and largest value. */
struct Span
{
    double low = 0, high = 0;
    double size() const { return high - low; }
};

/** The values without the given share at each end; {0, 0} without values. Reorders its argument. */
Span robustSpan(std::vector<double>& values, double share_left_out);

/** The points of which all three coordinates are finite. */
PointCloud finitePoints(const PointCloud& points);

/** The points without the ceiling, if there is one: where something flat hangs over a good part of
 * the map, with nothing between it and the body's height, all that lies above half of that
 * clearance over the body's (nearest) height is left out. Walls and what stands on the floor stay
 * up to there; facades and trees are no ceiling. */
PointCloud withoutCeiling(const PointCloud& points, const std::vector<Pose>& trajectory);

/** At most `max_points` of the points, spread evenly over the surfaces: the first point of each
 * voxel, with the voxels just as large as needed. */
PointCloud thinned(const PointCloud& points, std::size_t max_points);

/** The points without strays: those in voxels (of a 48th of the map's diagonal) that hold hardly
 * any points, compared with the voxel of the median point. For framing a picture. */
PointCloud withoutStrays(const PointCloud& points);

/** Mean distance of neighbouring points [m], taking them to lie evenly on surfaces; 0 for fewer
 * than two. */
double meanSpacing(const PointCloud& points);
}  // namespace taut
