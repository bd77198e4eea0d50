#include "taut/places/Register.h"

#include "taut/places/NearbyPlaces.h"

namespace taut
{
void registerPlaceRecognizers()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(NearbyPlaces, taut));
}
}  // namespace taut
