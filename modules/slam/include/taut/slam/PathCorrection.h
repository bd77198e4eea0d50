#pragma once

#include <vector>

#include "taut/core/Submap.h"

namespace taut
{
/** The poses of the scans of a submap (T_world_imu, in the order of Submap::scans) along the
 * corrected path: the submap stands at `T_world_submap`, and the gap to where the submap after it
 * stands, `T_world_next`, is spread over the scans in between.
 *
 * The most probable share of scan m in the gap xi is S_m S_M^-1 xi, where S_m is the covariance of
 * what the odometry has gained in error up to scan m (SubmapScan): the closed form of a smoother on
 * a chain. Where the odometry was sure, nothing moves.
 *
 * `T_submap_next`: where the odometry has the next submap. */
std::vector<Pose> correctedPoses(
    const Submap& submap, const Pose& T_world_submap, const Pose& T_submap_next,
    const Pose& T_world_next);

/** The same for the last submap: it moves as a whole. */
std::vector<Pose> correctedPoses(const Submap& submap, const Pose& T_world_submap);
}  // namespace taut
