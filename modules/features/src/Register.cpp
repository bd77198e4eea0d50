#include "taut/features/Register.h"

#include "taut/features/CurvatureExtractor.h"
#include "taut/features/VoxelThinning.h"

namespace taut
{
void registerFeatureExtractors()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(CurvatureExtractor, taut));
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(VoxelThinning, taut));
}
}  // namespace taut
