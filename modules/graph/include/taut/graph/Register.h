#pragma once

namespace taut
{
/** Makes the classes of this module known to MRPT's class factory. */
void registerGraphOptimizers();
}  // namespace taut
