#pragma once

#include "taut/simulation/Random.h"
#include "taut/simulation/World.h"

namespace taut::simulation
{
World makeHall(Random& random);
World makeCorridor(Random& random);
World makeStairwell(Random& random);
World makeStreet(Random& random);
World makeForest(Random& random);
}  // namespace taut::simulation
