#include "taut/odometry/transformScan.h"

namespace taut
{
Scan transformScan(const Scan& scan, const RangeConfig& range, Time begin)
{
    Scan out;
    out.stamp = scan.stamp;
    out.end = scan.end;
    out.rings = scan.rings;
    out.already_undistorted = scan.already_undistorted;
    out.sensor_label = scan.sensor_label;
    out.points.reserve(scan.points.size());

    const Eigen::Matrix3f R = scan.T_imu_lidar.R.cast<float>();
    const Eigen::Vector3f p = scan.T_imu_lidar.p.cast<float>();
    const auto min2 = static_cast<float>(range.min * range.min);
    const auto max2 = static_cast<float>(range.max * range.max);
    for (const LidarPoint& point : scan.points)
    {
        const float r2 = point.position.squaredNorm();
        const Time t = scan.timeOf(point);
        if (!(r2 >= min2 && r2 <= max2) || t <= begin || t > scan.end) continue;
        out.points.push_back(point);
        out.points.back().position = R * point.position + p;
    }
    return out;
}
}  // namespace taut
