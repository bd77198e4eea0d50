#include "taut/graph/Register.h"

#include "taut/graph/DenseGraphOptimizer.h"
#include "taut/graph/SparseGraphOptimizer.h"

namespace taut
{
void registerGraphOptimizers()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(SparseGraphOptimizer, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(DenseGraphOptimizer, taut));
}
}  // namespace taut
