#pragma once

#include <vector>

#include "taut/core/Correspondence.h"
#include "taut/core/Map.h"

namespace taut
{
/** Takes from matches with planes what errors of their normals pretend to know. A wall says nothing
 * of the direction along itself; but normals of a thousand windows on it, each wrong by a degree or
 * two, together claim to, with the same error in every scan. Along each principal direction u of
 * the scan's matches, a plane that faces u by less than `normal_error` [rad] is turned to stand
 * across it, about the foot of its query, so that the residual stays. Real knowledge of u comes
 * from planes that do face it, and is not touched.
 * \param queries in the world, one a correspondence
 */
void removeNormalErrors(
    const std::vector<MapPoint>& queries, double normal_error,
    std::vector<Correspondence>& correspondences);
}  // namespace taut
