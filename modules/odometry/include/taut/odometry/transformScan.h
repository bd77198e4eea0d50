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

/** Scan Transformation (paper, section II-A): the points from the LiDAR's frame to the body's, so
 * that later stages know of one frame only. Points out of range, or measured at or before `begin`
 * (the time of the previous state) or after the scan's end, are dropped. */
Scan transformScan(const Scan& scan, const RangeConfig& range, Time begin);
}  // namespace taut
