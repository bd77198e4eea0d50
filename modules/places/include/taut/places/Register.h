#pragma once

namespace taut
{
/** Tells MRPT's class factory of the place recognisers of this module. */
void registerPlaceRecognizers();
}  // namespace taut
