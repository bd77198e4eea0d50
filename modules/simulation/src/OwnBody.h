#pragma once

#include "taut/simulation/Lidar.h"
#include "taut/simulation/Mesh.h"

namespace taut::simulation
{
/** Surfaces of what carries a LiDAR, in its frame; empty for OwnBody::None. */
Mesh makeOwnBody(OwnBody kind);
}  // namespace taut::simulation
