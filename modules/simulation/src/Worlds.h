#pragma once

#include "taut/simulation/Random.h"
#include "taut/simulation/World.h"

namespace taut::simulation
{
World makeHall(Random& random);
}  // namespace taut::simulation
