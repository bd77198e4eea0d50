#include "taut/odometry/transformScan.h"

namespace taut
{
bool isUsable(const LidarPoint& point, const Scan& scan, const RangeConfig& range, Time begin)
{
    const auto min2 = static_cast<float>(range.min * range.min);
    const auto max2 = static_cast<float>(range.max * range.max);
    const float r2 = point.position.squaredNorm();
    const Time t = scan.timeOf(point);
    return r2 >= min2 && r2 <= max2 && t > begin && t <= scan.end;
}

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
    for (const LidarPoint& point : scan.points)
    {
        if (!isUsable(point, scan, range, begin)) continue;
        out.points.push_back(point);
        out.points.back().position = R * point.position + p;
    }
    return out;
}

Scan thinned(const Scan& scan, std::size_t most)
{
    const std::size_t n = scan.points.size();
    const std::size_t stride = n > most ? (n + most - 1) / most : 1;
    Scan out{scan.stamp, scan.end, {}, scan.rings, scan.already_undistorted, scan.sensor_label, {}};
    out.points.reserve((n + stride - 1) / stride);
    for (std::size_t i = 0; i < n; i += stride) out.points.push_back(scan.points[i]);
    return out;
}
}  // namespace taut
