#pragma once

#include <vector>

#include "taut/core/Scan.h"
#include "taut/factors/SweepPath.h"

namespace taut
{
/** A sweep with all that its path is made of, so that its points can be undistorted again when its
 * ends are known better: by the scan after it, or after a loop was closed. Thread-safe to read. */
struct Sweep
{
    Scan scan;         //!< raw points in the body frame at their own times
    Pose T_imu_lidar;  //!< where the rays began
    Undistortion mode = Undistortion::None;
    PreintegratedImu motion;                    //!< from the end of the sweep back to `begin`
    Vector3d previous_rate = Vector3d::Zero();  //!< that the motion was integrated with [rad/s]
    ImuNoise noise;                             //!< the same
    bool with_imu = true;                       //!< false: by constant velocity
    NavState prior_begin;                       //!< the states before the sweep was matched
    NavState prior_end;
    NavState begin;  //!< the state at the end of the sweep before, as this sweep left it
    NavState end;    //!< the state at the end of this sweep, as this sweep left it

    /** The points in the world frame [m] along the path between two end states. Same order as
     * scan.points. */
    std::vector<Vector3d> undistorted(const NavState& from, const NavState& to) const;
};
}  // namespace taut
