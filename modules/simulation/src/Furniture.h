#pragma once

#include "taut/simulation/Mesh.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
/** A cabinet, table, crate, drum or shelf of random size, on the origin of its frame. */
Mesh makeFurniture(Random& random);
}  // namespace taut::simulation
