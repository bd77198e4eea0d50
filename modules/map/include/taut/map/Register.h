#pragma once

namespace taut
{
/** Makes the maps of this module known to MRPT's class factory. */
void registerMaps();
}  // namespace taut
