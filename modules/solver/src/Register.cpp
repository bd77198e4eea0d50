#include "taut/solver/Register.h"

#include "taut/solver/GaussNewton.h"
#include "taut/solver/NloptSolver.h"

namespace taut
{
void registerSolvers()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(GaussNewton, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(NloptSolver, taut));
}
}  // namespace taut
