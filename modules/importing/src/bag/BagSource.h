#pragma once

#include "../ImportFormat.h"

namespace taut
{
/** True for a ROS bag, by its content, and for a folder of them. */
bool isBag(const Recording& recording);

/** Reads a ROS 1 bag (format 2.0) or a ROS 2 bag (MCAP, sqlite3; a file or the bag's folder):
 * sweeps from sensor_msgs/PointCloud2 and Livox CustomMsg, or from packets (PacketSource.h);
 * readings from sensor_msgs/Imu. Scans have their points' own times, the stamp of the first of
 * them, and the pose that tf tells; no label. Readings are as the message has them.
 *
 * The first sweeps are read ahead to judge what times and stamps mean; see findings().
 * Warnings:
 *   bag_truncated      the file ends early; what is complete was read
 *   bag_unindexed      a ROS 1 bag that was not closed; the same
 *   bag_damaged        a part of the file contradicts itself and was left out
 *   bag_file_missing   a part of a split bag is not there
 *   message_invalid    a message that is not what its type says was left out
 *   no_stamp           a message whose stamp is zero was left out
 *   no_imu             no reading in the whole bag
 *   scan_stamp         which end of a sweep its stamp means is contradicted or cannot be told
 *   scan_bad_points    more than 5 % of the points with an impossible time (left out)
 *   scan_empty         a cloud without a valid point (left out)
 *   clock_offset       the stamps of the LiDAR and of the IMU are of clocks that differ
 *   second_sensor      sweeps of another sensor on the same topic were left out
 *   tf_invalid, pose_unknown   see LidarPose.h
 *
 * Throws std::runtime_error, naming file and cause, if the file cannot be read as a bag or its
 * topics are ambiguous or absent; next() throws if the bag had no sweep that could be used. */
std::unique_ptr<ImportSource> openBag(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);
}  // namespace taut
