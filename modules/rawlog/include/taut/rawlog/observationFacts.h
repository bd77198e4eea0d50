#pragma once

#include <optional>

#include "taut/core/Time.h"

namespace mrpt::obs
{
class CObservation;
}

namespace taut
{
/** Scan::stamp of the scan that RawlogSource makes of the observation, without what a rig adds to
 * it. Nothing if it is of no LiDAR that taut knows, or has no valid stamp. */
std::optional<Time> stampOfScan(const mrpt::obs::CObservation& observation);
}  // namespace taut
