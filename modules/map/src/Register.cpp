#include "taut/map/Register.h"

#include "taut/map/KdTreeMap.h"
#include "taut/map/OctreeMap.h"

namespace taut
{
void registerMaps()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(KdTreeMap, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(OctreeMap, taut));
}
}  // namespace taut
