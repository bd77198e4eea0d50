#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** One return of a LiDAR, raw: as measured, in the frame the sensor had at the time of the point.
 */
struct LidarPoint
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m]
    float intensity = 0;                                 //!< as the sensor gives it
    std::int32_t offset = 0;                             //!< time since Scan::stamp [ns]
    std::uint16_t ring = 0;  //!< laser or row; 0 for sensors without rings
};

/** One sweep of a LiDAR. The points need not be in the order of time. */
struct Scan
{
    Time stamp = 0;  //!< reference of the points' offsets; usually the start of the sweep
    Time end = 0;    //!< time of the state that this scan estimates: of its last point, or of the
                     //!< end of the sweep where the sensor gives it
    std::vector<LidarPoint> points;
    int rings = 0;                     //!< number of rings; 0 if the sensor has none
    bool already_undistorted = false;  //!< all points refer to one time: do not undistort again
    std::string sensor_label;
    Pose T_imu_lidar;  //!< frame of the points in the body frame; identity after transformScan()

    Time timeOf(const LidarPoint& point) const { return stamp + point.offset; }
};
}  // namespace taut
