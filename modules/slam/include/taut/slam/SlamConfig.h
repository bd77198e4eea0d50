#pragma once

#include "taut/core/GraphOptimizer.h"
#include "taut/core/Map.h"
#include "taut/core/PlaceRecognizer.h"
#include "taut/core/Plugins.h"
#include "taut/loops/LoopJudge.h"
#include "taut/submaps/SubmapBuilder.h"

namespace taut
{
/** How loops are found, believed and closed. A value. */
struct SlamConfig
{
    bool loops = true;  //!< close loops; else the odometry's path is the result
    SubmapConfig submap;
    LoopJudgeConfig judge;
    Prototype<PlaceRecognizer> places;      //!< near by the estimate
    Prototype<PlaceRecognizer> appearance;  //!< where the estimate does not tell
    Prototype<GraphOptimizer> optimizer;
    Prototype<Map> map;  //!< of a submap; that of the odometry

    /** Reads section `slam`. Throws ConfigError. */
    static SlamConfig read(ConfigSection& section, const Prototype<Map>& map);
};
}  // namespace taut
