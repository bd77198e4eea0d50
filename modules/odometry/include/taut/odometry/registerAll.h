#pragma once

namespace taut
{
/** Makes every strategy of taut known to MRPT's class factory: the one list of them. */
void registerAll();
}  // namespace taut
