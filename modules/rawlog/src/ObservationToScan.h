#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/obs_frwds.h>

#include "taut/rawlog/Rig.h"
#include "taut/rawlog/ScanBuilder.h"

namespace mrpt::obs
{
class CObservationRotatingScan;
}

namespace taut
{
/** True if the observation is of a class that observationToPoints() understands. */
bool isLidar(const mrpt::obs::CObservation& observation);

/** The points of an observation, in the sensor's frame, at times of the sensor's own clock. Throws
 * std::runtime_error with the cause if its content contradicts itself. */
ScanBuilder observationToPoints(const mrpt::obs::CObservation& observation, const LidarRig& rig);

/** Raw packets where there are any, else the filled point cloud. */
ScanBuilder velodyneToPoints(const mrpt::obs::CObservationVelodyneScan& scan);

/** The main layer of the range image. Columns are spread evenly over azimuthSpan, the last one at
 * its end (a full turn: one column before), and over sweepDuration in the same way. */
ScanBuilder rotatingScanToPoints(
    const mrpt::obs::CObservationRotatingScan& scan, const LidarRig& rig);
}  // namespace taut
