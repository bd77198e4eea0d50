#pragma once

#include <string>
#include <vector>

#include "taut/trajectory/Trajectory.h"

namespace taut
{
/** Which difference of the two world frames is taken away before the absolute error is measured. */
enum class Alignment
{
    SE3,    //!< rotation and translation (Umeyama without scale): 6 dof
    Yaw,    //!< rotation about z and translation: 4 dof, what a LiDAR-IMU system cannot know
    None,   //!< nothing
    Given,  //!< what is known from elsewhere
};

/** "se3", "yaw", "none", "given". */
std::string nameOf(Alignment alignment);

/** The opposite, but for "given". Throws std::invalid_argument for any other name. */
Alignment alignmentOf(const std::string& name);

/** Truth and estimate at one stamp. */
struct PosePair
{
    Time t = 0;
    Pose truth;     //!< T_world_imu in the world of the truth
    Pose estimate;  //!< T_world_imu in the world of the estimate
};

using PosePairs = std::vector<PosePair>;

/** Whether the truth has clearly fewer poses a second than the estimate. */
bool isSparser(const Trajectory& truth, const Trajectory& estimate);

/** The denser of both interpolated to the stamps of the other: between sparse poses nobody knows
 * what happened. Stamps outside of the denser, or in a gap of it (see TrajectoryInterpolator), give
 * no pair. */
PosePairs pairPoses(
    const Trajectory& truth, const Trajectory& estimate, Duration max_truth_gap = 0,
    Duration max_estimate_gap = 0);

/** T_truth_estimate that minimises sum |p_truth - T p_estimate|^2 over the dof of the alignment
 * (Umeyama, PAMI 1991). Throws std::runtime_error if the positions do not determine it: less than 1
 * mm of spread off a line (SE3) or in the horizontal plane (Yaw). Not for Given. */
Pose align(const PosePairs& pairs, Alignment alignment);
}  // namespace taut
