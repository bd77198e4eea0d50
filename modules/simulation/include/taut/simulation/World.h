#pragma once

#include <cstdint>

#include "taut/core/Config.h"
#include "taut/simulation/Mesh.h"
#include "taut/simulation/Route.h"

namespace taut::simulation
{
enum class WorldType
{
    Hall,  //!< 36 x 22 x 7 m with pillars, racks and crates
};

struct WorldConfig
{
    WorldType type = WorldType::Hall;
    int seed = 1;  //!< of what is placed at random
};

void declare(ConfigSection& section, WorldConfig& config);

/** Surfaces, and a closed route that keeps clear of them. World frame: z up. */
struct World
{
    Mesh mesh;
    Route route;
};

World makeWorld(const WorldConfig& config);
}  // namespace taut::simulation
