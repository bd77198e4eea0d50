#pragma once

#include <functional>
#include <vector>

#include "taut/core/Parallel.h"
#include "taut/core/Scan.h"
#include "taut/inspection/RotationAlignment.h"

namespace taut
{
/** What the gyro is believed to say of the path within a sweep. */
struct GyroHint
{
    const GyroRotation* gyro = nullptr;
    double clock_offset = 0;  //!< [s] added to the LiDAR's stamps gives the gyro's clock
    Matrix3d R_imu_lidar = Matrix3d::Identity();
};

/** How the LiDAR turned from the end of each sweep to the end of the next, by scan matching (the
 * odometry without IMU factor). Without a hint, a constant velocity is assumed within a sweep. The
 * scans need a time for each point and must be in the order of time; `done` hears of each.
 * registerAll() must have been called. */
LidarTurns matchScans(
    const std::vector<Scan>& scans, const GyroHint* hint, Executor& executor,
    const std::function<void(std::size_t)>& done = {});
}  // namespace taut
