#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Parallel.h"
#include "taut/core/Scan.h"
#include "taut/inspection/Finding.h"
#include "taut/inspection/RotationAlignment.h"

namespace taut
{
/** What comparing the gyro with the rotation from scan matching tells of clocks and mounting. */
struct RotationFacts
{
    Time begin = 0, end = 0;    //!< the part of the recording that was compared
    std::string not_estimated;  //!< why there is no result; empty if there is
    RotationAlignment alignment;
    double applied_offset = 0;  //!< [s] clock offset that the rig applied already
    double gyro_factor = 1;     //!< of the gyro's values to rad/s
    double angle = 0;        //!< [rad] of the rotation from the configured to the found extrinsic
    double angle_sigma = 0;  //!< [rad] in that direction
    double worst_sigma = 0;  //!< [rad] about the axis known least
    bool offset_known = false, rotation_known = false;  //!< well enough to be judged
};

/** Compares a stretch of a recording. The scans are matched first along the gyro's path; if that
 * does not fit, at constant velocity, and then along the gyro's path by what that told of clocks,
 * units and mounting. `done` hears the share of the work that is done.
 * registerAll() must have been called. */
RotationFacts compareRotations(
    const std::vector<Scan>& scans, const ImuSamples& imu, Executor& executor,
    const std::function<void(double)>& done = {});

/** Clock offset, rotation of the extrinsic, and rotations that do not fit at all. */
Findings findingsOf(const RotationFacts& facts);
}  // namespace taut
