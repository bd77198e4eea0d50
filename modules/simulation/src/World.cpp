#include "taut/simulation/World.h"

#include "Worlds.h"

namespace taut::simulation
{
void declare(ConfigSection& section, WorldConfig& config)
{
    section.choice<WorldType>("type", config.type, {{"hall", WorldType::Hall}}, "kind of world");
    section.key("seed", config.seed, {0, 1e9}, "of what is placed at random");
}

World makeWorld(const WorldConfig& config)
{
    Random random(static_cast<std::uint64_t>(config.seed), 2);
    return makeHall(random);
}
}  // namespace taut::simulation
