#pragma once

#include "taut/core/Scan.h"
#include "taut/core/Time.h"

namespace taut
{
struct RangeConfig
{
    double min = 0.5;    //!< [m] nearer returns are of the carrier
    double max = 100.0;  //!< [m]
};

/** Whether a point of a scan can be used: in range, and measured after `begin` (the time of the
 * previous state) and not after the scan's end. */
bool isUsable(const LidarPoint& point, const Scan& scan, const RangeConfig& range, Time begin);

/** Scan Transformation (paper, section II-A): the points from the LiDAR's frame to the body's, so
 * that later stages know of one frame only. Points that are not usable are dropped. */
Scan transformScan(const Scan& scan, const RangeConfig& range, Time begin);

/** The scan with at most so many of its points, evenly taken in their order. */
Scan thinned(const Scan& scan, std::size_t most);
}  // namespace taut
