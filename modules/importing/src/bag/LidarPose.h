#pragma once

#include <optional>
#include <string>
#include <vector>

#include "BagReader.h"
#include "taut/core/Geometry.h"

namespace taut::bag
{
/** What a bag tells of where its LiDAR is on its IMU. */
struct LidarPose
{
    std::optional<Pose> T_imu_lidar;  //!< nothing: it is not told
    std::string finding;              //!< how it is told, or that it is not: for the summary
};

/** Reads the frames that the headers of the two topics name, and the transforms between them:
 * /tf_static (every topic of tf2_msgs/TFMessage of that name, in any namespace) and, where that
 * does not join them, /tf as far as it does not move. Reads the bag's first seconds, and on to its
 * end where these do not tell. Warnings:
 *   tf_invalid     a transform that is not finite or has no rotation was left out
 *   pose_unknown   there are transforms, but none, or no unambiguous ones, between the two frames
 * Throws std::runtime_error if the bag cannot be read. */
LidarPose findLidarPose(
    const std::string& path, const std::vector<BagTopic>& topics, const BagTopic& lidar,
    const BagTopic& imu, const WarningSink& warn);
}  // namespace taut::bag
