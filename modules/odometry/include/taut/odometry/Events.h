#pragma once

#include <functional>
#include <string>
#include <variant>

#include "taut/odometry/Odometry.h"

namespace taut
{
/** The estimation begins at this state. */
struct Started
{
    Initialization initialization;
    bool with_imu = true;
};

/** A scan was matched. The references are valid during the call. */
struct Estimated
{
    const Scan& scan;  //!< raw
    const ScanResult& result;
};

/** The state at the end of a sweep is final: the scan after it has moved it for the last time. The
 * reference is valid during the call. */
struct Refined
{
    const Sweep& sweep;
    NavState state;  //!< at the end of the sweep

    /** The points of the sweep along its final path, world frame [m]. */
    std::vector<Vector3d> points() const { return sweep.undistorted(sweep.begin, state); }
};

/** From here on the pose is in doubt. */
struct Lost
{
    Time t = 0;
    /** Kind of the warning that says why: pose_doubtful, few_correspondences, imu_silent,
     * position_open. */
    std::string cause;
};

/** From here on it is not any more. */
struct Recovered
{
    Time t = 0;
    std::string cause;  //!< of the loss that is over
};

/** No more data. */
struct Ended
{
    Time t = 0;  //!< of the last state; 0 if there was none
};

/** What a Pipeline tells, in the order of time. */
using Event = std::variant<Started, Estimated, Refined, Lost, Recovered, Ended>;
using EventSink = std::function<void(const Event&)>;
}  // namespace taut
