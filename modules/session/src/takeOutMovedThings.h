#pragma once

#include "taut/session/MapExport.h"
#include "taut/slam/Mapper.h"

namespace taut
{
/** Moves the points of what has gone from map.ply to map_moved.ply. `map` is finished and along the
 * mapper's final path. Gives their number. */
std::size_t takeOutMovedThings(Mapper& mapper, MapExport& map, Executor& executor);
}  // namespace taut
