#include "taut/map/Register.h"

#include "taut/map/KdTreeMap.h"

namespace taut
{
void registerMaps()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(KdTreeMap, taut));
}
}  // namespace taut
