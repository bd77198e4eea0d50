#pragma once

#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** Where the body was at one time. */
struct StampedPose
{
    Time t = 0;
    Pose T_world_imu;
};

using Trajectory = std::vector<StampedPose>;  //!< strictly increasing in time

/** Throws std::invalid_argument, naming both stamps, unless the times increase strictly. */
void requireIncreasing(const Trajectory& trajectory);

/** Median time between neighbours [ns]; 0 with fewer than two poses. */
Duration medianSpacing(const Trajectory& trajectory);

/** Sum of the distances between neighbours [m]. Noise lengthens it, the more the denser the poses.
 */
double pathLength(const Trajectory& trajectory);

/** Angle of a rotation [rad], in [0, pi]; exact for small angles too. */
double angleOf(const Matrix3d& R);
}  // namespace taut
