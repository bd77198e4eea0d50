#pragma once

#include "taut/simulation/Random.h"
#include "taut/simulation/World.h"

namespace taut::simulation
{
World makeHall(const WorldConfig& config, Random& random);
World makeCorridor(Random& random);
World makeStairwell(Random& random);
World makeStreet(const WorldConfig& config, Random& random);
World makeForest(Random& random);
World makeStoreys(const WorldConfig& config, Random& random);
World makeHalls(const WorldConfig& config, Random& random);
World makeBlocks(const WorldConfig& config, Random& random);
World makeTunnel(const WorldConfig& config, Random& random);
World makeField(Random& random);
}  // namespace taut::simulation
