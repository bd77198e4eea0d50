#include "ObservationToScan.h"

#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <stdexcept>

namespace taut
{
using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;

bool isLidar(const mrpt::obs::CObservation& observation)
{
    return dynamic_cast<const CObservationVelodyneScan*>(&observation) ||
           dynamic_cast<const CObservationRotatingScan*>(&observation);
}

ScanBuilder observationToPoints(const mrpt::obs::CObservation& observation, const LidarRig& rig)
{
    if (const auto* o = dynamic_cast<const CObservationVelodyneScan*>(&observation))
        return velodyneToPoints(*o);
    if (const auto* o = dynamic_cast<const CObservationRotatingScan*>(&observation))
        return rotatingScanToPoints(*o, rig);
    throw std::logic_error("not a LiDAR");
}
}  // namespace taut
