#pragma once

#include "taut/core/Scan.h"
#include "taut/inspection/Finding.h"
#include "taut/inspection/IntervalStatistics.h"

namespace taut
{
/** What a LiDAR's scans tell by themselves. */
struct LidarFacts
{
    std::size_t scans = 0;
    Time begin = 0, end = 0;  //!< of the first and the last point
    double rate = 0;          //!< [Hz] by the median interval
    double sweep = 0;         //!< [s] median, from first to last point
    double hole = 0;          //!< [s] median, from the last point to the next sweep's first
    std::size_t min_points = 0, max_points = 0;
    double mean_points = 0;
    int rings = 0;
    double stamp_at = 0;          //!< mean place of the stamp in the sweep: 0 start, 1 end
    std::size_t undistorted = 0;  //!< scans without times of their points
};

/** Looks at the scans of a LiDAR as they pass by. */
class LidarInspector
{
 public:
    /** Scans with at least one point, in the order of time, as RawlogSource gives them. */
    void add(const Scan& scan);

    LidarFacts facts() const;

    /** Gaps, holes between sweeps, scans that are undistorted already. */
    Findings findings(const LidarFacts& facts) const;

 private:
    IntervalStatistics intervals_, sweeps_, holes_;
    LidarFacts sums_;
    Time last_stamp_ = 0, first_undistorted_ = 0;
    double points_ = 0, stamps_ = 0;
};
}  // namespace taut
