#include "taut/places/Register.h"

#include "taut/places/NearbyPlaces.h"
#include "taut/places/PlacesByView.h"

namespace taut
{
void registerPlaceRecognizers()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(NearbyPlaces, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(PlacesByView, taut));
}
}  // namespace taut
