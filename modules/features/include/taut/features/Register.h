#pragma once

namespace taut
{
/** Makes the extractors of this module known to MRPT's class factory. */
void registerFeatureExtractors();
}  // namespace taut
