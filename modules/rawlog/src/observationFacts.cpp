#include "taut/rawlog/observationFacts.h"

#include "MrptConversion.h"
#include "ObservationToScan.h"

namespace taut
{
std::optional<Time> stampOfScan(const mrpt::obs::CObservation& observation)
{
    if (!isLidar(observation) || !isValidStamp(observation.timestamp)) return {};
    return toTime(observation.timestamp);
}
}  // namespace taut
