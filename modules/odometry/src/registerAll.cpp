#include "taut/odometry/registerAll.h"

#include "taut/features/Register.h"
#include "taut/map/Register.h"
#include "taut/preintegration/Register.h"
#include "taut/solver/Register.h"

namespace taut
{
void registerAll()
{
    registerPreintegrators();
    registerFeatureExtractors();
    registerSolvers();
    registerMaps();
}
}  // namespace taut
