#pragma once

#include "PointSelection.h"
#include "taut/features/CurvatureExtractor.h"

namespace taut
{
/** What the ring looks like around a point. */
enum class Shape : std::uint8_t
{
    Unknown,  //!< no feature: too few neighbours, occluded, at a gap, seen at a grazing angle
    Curved,   //!< neither an edge nor a plane
    Edge,
    Plane
};

/** The shape of one ring, point by point. */
struct RingShape
{
    PointIndices points;           //!< in the order of time
    std::vector<float> curvature;  //!< tan(turn / 2)
    std::vector<Shape> shape;
};

/** Shape around every point of a ring, given in the order of time. `angular_step` is the angle
 * between consecutive beams [rad]. */
RingShape shapeOfRing(
    const Scan& scan, PointIndices points, double angular_step,
    const CurvatureExtractor::Config& config);
}  // namespace taut
