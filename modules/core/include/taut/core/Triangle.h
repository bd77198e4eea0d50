#pragma once

#include "taut/core/Geometry.h"

namespace taut
{
/** The point of triangle abc that is nearest to p; a triangle without area counts as its edges. */
Vector3d nearestOnTriangle(
    const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c);
}  // namespace taut
