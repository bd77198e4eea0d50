#include "taut/preintegration/Register.h"

#include "taut/preintegration/ConstantVelocityPreintegrator.h"
#include "taut/preintegration/MidpointPreintegrator.h"

namespace taut
{
void registerPreintegrators()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(MidpointPreintegrator, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(ConstantVelocityPreintegrator, taut));
}
}  // namespace taut
