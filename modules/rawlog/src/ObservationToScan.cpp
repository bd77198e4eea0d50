#include "ObservationToScan.h"

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <stdexcept>

#include "MrptConversion.h"

namespace taut
{
using mrpt::obs::CObservationVelodyneScan;

namespace
{
// A cloud that somebody filled point by point; times and lasers may be missing.
ScanBuilder fromPointCloud(const CObservationVelodyneScan& scan)
{
    const auto& cloud = scan.point_cloud;
    const std::size_t n = cloud.x.size();
    const auto fits = [n](const auto& values, bool required)
    { return values.size() == n || (!required && values.empty()); };
    if (!fits(cloud.y, true) || !fits(cloud.z, true) || !fits(cloud.intensity, false) ||
        !fits(cloud.timestamp, false) || !fits(cloud.laser_id, false))
        throw std::runtime_error("the vectors of its point cloud differ in length");

    const Time stamp = toTime(scan.timestamp);
    ScanBuilder builder(stamp, n);
    for (std::size_t i = 0; i < n; i++)
        builder.add(
            {cloud.x[i], cloud.y[i], cloud.z[i]},
            cloud.intensity.empty() ? 0.0f : static_cast<float>(cloud.intensity[i]),
            cloud.timestamp.empty() ? stamp : toTime(cloud.timestamp[i]),
            cloud.laser_id.empty() ? 0 : cloud.laser_id[i]);
    return builder;
}
}  // namespace

bool isLidar(const mrpt::obs::CObservation& observation)
{
    return dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr;
}

ScanBuilder observationToPoints(const mrpt::obs::CObservation& observation)
{
    return fromPointCloud(dynamic_cast<const CObservationVelodyneScan&>(observation));
}
}  // namespace taut
