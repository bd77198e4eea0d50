#pragma once

#include <mrpt/obs/CObservation.h>

#include "ScanBuilder.h"

namespace taut
{
/** True if the observation is of a class that observationToScan() understands. */
bool isLidar(const mrpt::obs::CObservation& observation);

/** Adds the points of an observation, in the sensor's frame, at times of the sensor's own clock.
 * Throws std::runtime_error with the cause if its content contradicts itself. */
ScanBuilder observationToPoints(const mrpt::obs::CObservation& observation);
}  // namespace taut
