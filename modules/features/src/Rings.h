#pragma once

#include <vector>

#include "PointSelection.h"

namespace taut
{
/** The candidates of each ring in the order in which the sensor measured them: by time, points of
 * one time by azimuth (about the z axis) in the sense of rotation. Throws std::runtime_error for a
 * ring that the scan does not have. */
std::vector<PointIndices> sortedRings(const Scan& scan, const PointIndices& candidates);

/** Typical angle between consecutive points of a ring [rad]; 0 if there are none. */
double angularStep(const Scan& scan, const std::vector<PointIndices>& rings);

/** Angle between the beams to two points [rad], for small angles. */
double angleBetween(const LidarPoint& a, const LidarPoint& b);
}  // namespace taut
