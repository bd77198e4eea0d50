#include "taut/inspection/LidarInspector.h"

#include <algorithm>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr double kGap = 1.5;   // times the usual interval
constexpr double kHole = 0.2;  // share of the usual interval that is not measured

Time beginOf(const Scan& scan)
{
    std::int32_t first = scan.points.front().offset;
    for (const LidarPoint& p : scan.points) first = std::min(first, p.offset);
    return scan.stamp + first;
}
}  // namespace

void LidarInspector::add(const Scan& scan)
{
    const Time begin = beginOf(scan);
    const std::size_t n = scan.points.size();
    if (sums_.scans == 0)
    {
        sums_.begin = begin;
        sums_.min_points = n;
    }
    else
    {
        intervals_.add(last_stamp_, scan.stamp - last_stamp_);
        holes_.add(sums_.end, begin - sums_.end);
    }
    sweeps_.add(begin, scan.end - begin);
    if (scan.end > begin)
        stamps_ += static_cast<double>(scan.stamp - begin) / static_cast<double>(scan.end - begin);
    if (scan.already_undistorted && sums_.undistorted++ == 0) first_undistorted_ = scan.stamp;
    sums_.scans++;
    sums_.end = scan.end;
    sums_.min_points = std::min(sums_.min_points, n);
    sums_.max_points = std::max(sums_.max_points, n);
    sums_.rings = std::max(sums_.rings, scan.rings);
    points_ += static_cast<double>(n);
    last_stamp_ = scan.stamp;
}

LidarFacts LidarInspector::facts() const
{
    LidarFacts f = sums_;
    if (f.scans == 0) return f;
    f.rate = intervals_.median() > 0 ? 1 / intervals_.median() : 0;
    f.sweep = sweeps_.median();
    f.hole = std::max(0.0, holes_.median());
    f.mean_points = points_ / static_cast<double>(f.scans);
    f.stamp_at = stamps_ / static_cast<double>(f.scans);
    return f;
}

Findings LidarInspector::findings(const LidarFacts& facts) const
{
    Findings found;
    const double usual = intervals_.median();
    if (const std::size_t gaps = intervals_.longer(kGap * usual); gaps > 0)
    {
        const auto& worst = intervals_.largest().front();
        found.push_back(
            {worst.begin, "lidar_gap", toSeconds(worst.length), "s", gaps,
             format(
                 "no scan for %.3f s, where one comes every %.3f s", toSeconds(worst.length),
                 usual),
             "scans were lost or a clock was set forward: look at the network, the disk and the "
             "queue of the recorder; taut "
             "bridges short gaps by the IMU alone"});
    }
    if (facts.undistorted < facts.scans && facts.hole > kHole * usual)
        found.push_back(
            {holes_.largest().front().begin, "lidar_holes", facts.hole, "s",
             holes_.longer(kHole * usual),
             format(
                 "the LiDAR measures for %.3f s and then nothing for %.3f s, sweep by sweep",
                 facts.sweep, facts.hole),
             "if the sensor spins on, packets are lost or cut away; if its field is narrow by "
             "design, nothing"});
    if (facts.undistorted > 0)
        found.push_back(
            {first_undistorted_, "scan_undistorted", static_cast<double>(facts.undistorted),
             "scans", facts.undistorted,
             "the points of scans have no times, or all the same: they are taken as undistorted "
             "already",
             "record the raw packets, or points with times; undistorted by somebody else, they "
             "keep that one's errors"});
    return found;
}
}  // namespace taut
