#pragma once

#include <functional>
#include <string>
#include <vector>

#include "taut/core/Measurement.h"
#include "taut/odometry/SweepReplay.h"
#include "taut/session/MapExport.h"
#include "taut/slam/Mapper.h"

namespace taut
{
/** The records with their states on a corrected path: `path` has one pose more than there are
 * records, the one that the first sweep begins at. Velocities and predicted states turn with their
 * poses; biases keep their values. */
std::vector<SweepRecord> corrected(std::vector<SweepRecord> records, const std::vector<Pose>& path);

/** Streams a recording again and undistorts every point along the corrected path. True if it went
 * through to the end; `go_on` (share of the stream) may stop it. */
bool undistortAgain(
    MeasurementStream& log, const OdometryConfig& config, const std::vector<SweepRecord>& records,
    MapExport& map, const std::function<bool(double)>& go_on);

/** Where the recording is not there any more: the points of a run's submaps, which each scan takes
 * along to its corrected pose. `path`: all of the run's. */
void moveSubmaps(
    const Mapper& mapper, const Mapper::Run& run, const std::vector<Pose>& path, MapExport& map);
}  // namespace taut
