#pragma once

#include <memory>

#include "taut/rawlog/RawlogWriter.h"

namespace mrpt::obs
{
class CObservation;
}

namespace taut
{
/** What RawlogWriter writes of an item, as an observation of its own: for other programs that write
 * rawlogs. Labels, and the pose of the vehicle's IMU, are those of the configuration. */
std::shared_ptr<mrpt::obs::CObservation> toObservation(
    const ImuSample& sample, const RawlogWriterConfig& config);
std::shared_ptr<mrpt::obs::CObservation> toObservation(
    const Scan& scan, const RawlogWriterConfig& config);
std::shared_ptr<mrpt::obs::CObservation> toObservation(
    const PacketScan& scan, const RawlogWriterConfig& config);
}  // namespace taut
