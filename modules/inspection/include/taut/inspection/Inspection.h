#pragma once

#include <functional>
#include <optional>
#include <string>

#include "taut/core/Parallel.h"
#include "taut/inspection/ImuInspector.h"
#include "taut/inspection/LidarInspector.h"
#include "taut/inspection/RotationCheck.h"
#include "taut/rawlog/RawlogSource.h"

namespace taut
{
struct InspectionConfig
{
    RawlogConfig log;
    double window = 20;       //!< [s] that is matched, chosen where the body turns most
    bool match_scans = true;  //!< false: clock offset and extrinsic rotation are not looked at
};

/** What a recording is like. */
struct Inspection
{
    StreamProgress log;                     //!< sensors and counts
    bool incomplete = false;                //!< the file ends early or is damaged
    std::optional<LidarFacts> lidar;        //!< none: no scan could be read
    std::optional<ImuFacts> imu;            //!< none: no sample could be read
    std::optional<RotationFacts> rotation;  //!< none: not looked at
    Findings findings;
};

/** Reads the recording once, and the window that is matched once more; memory is bounded by the
 * window (its scans are thinned). What ends the
 * reading early is a finding. Throws std::runtime_error if nothing can be read at all.
 * `progress` hears the share of the work that is done, the scans and the seconds read.
 * registerAll() must have been called. */
Inspection inspectRecording(
    const InspectionConfig& config, Executor& executor,
    const std::function<void(double, std::size_t, double)>& progress = {});
}  // namespace taut
