#pragma once

#include <string>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Time.h"
#include "taut/simulation/Motion.h"

namespace taut::simulation
{
/** A recorded pose of the body. */
struct RecordedPose
{
    Time t = 0;
    Pose pose;
};

struct ReplayConfig
{
    std::string file;        //!< of the trajectory; whoever reads it passes the poses on
    double smoothing = 0.1;  //!< standard deviation of the kernel [s]
    Pose T_world_origin;     //!< where in the world the trajectory's origin is put
};

void declare(ConfigSection& section, ReplayConfig& config);

/** A recorded trajectory as a smooth motion: weighted means of its poses become the control points
 * of the spline, so noise does not become acceleration. With a rest, the first pose is held, and
 * then the recording starts to run slowly. Throws std::runtime_error if times do not increase, on
 * gaps of more than 0.5 s or the width of the kernel, and if the recording is shorter than duration
 * - rest [s]. */
Motion makeReplay(
    const std::vector<RecordedPose>& recording, const ReplayConfig& config, double spacing,
    double duration, double rest);
}  // namespace taut::simulation
