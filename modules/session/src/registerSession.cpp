#include "taut/session/registerSession.h"

#include "taut/graph/Register.h"
#include "taut/odometry/registerAll.h"
#include "taut/places/Register.h"

namespace taut
{
void registerSession()
{
    registerAll();
    registerPlaceRecognizers();
    registerGraphOptimizers();
}
}  // namespace taut
