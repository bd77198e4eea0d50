#pragma once

#include "../ImportFormat.h"

namespace taut
{
/** DATE/DATE_drive_NNNN_sync or _extract: velodyne_points with timestamps_start.txt. */
bool isKittiRaw(const Recording& recording);
std::unique_ptr<ImportSource> openKittiRaw(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);

/** data_3d_raw/DRIVE of KITTI-360: velodyne_points with timestamps.txt alone. */
bool isKitti360(const Recording& recording);
std::unique_ptr<ImportSource> openKitti360(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);

/** sequences/NN of the odometry benchmark: velodyne and times.txt. */
bool isKittiOdometry(const Recording& recording);
std::unique_ptr<ImportSource> openKittiOdometry(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);
}  // namespace taut
