#include "taut/core/Plugins.h"

#include "taut/core/FeatureExtractor.h"
#include "taut/core/GraphOptimizer.h"
#include "taut/core/Map.h"
#include "taut/core/PlaceRecognizer.h"
#include "taut/core/Preintegrator.h"
#include "taut/core/Renderer.h"
#include "taut/core/Solver.h"

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Preintegrator, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(FeatureExtractor, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Map, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Solver, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(PlaceRecognizer, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(GraphOptimizer, mrpt::rtti::CObject, taut)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Renderer, mrpt::rtti::CObject, taut)
