#include "taut/rawlog/ScanBuilder.h"

#include <algorithm>
#include <utility>

namespace taut
{
namespace
{
constexpr Duration kLargestOffset = 2'000'000'000;  // fits 32 bits; no LiDAR sweeps that slowly
}

ScanBuilder::ScanBuilder(Time stamp, std::size_t expected_points)
{
    scan_.stamp = stamp;
    scan_.points.reserve(expected_points);
}

void ScanBuilder::add(const Eigen::Vector3f& position, float intensity, Time t, int ring)
{
    seen_++;
    const Duration offset = t - scan_.stamp;
    if (offset <= -kLargestOffset || offset >= kLargestOffset)
    {
        bad_time_++;
        return;
    }
    first_ = std::min(first_, offset);
    last_ = std::max(last_, offset);
    last_ring_ = std::max(last_ring_, ring);
    if (!position.allFinite())
        not_finite_++;
    else if (position.isZero(0))
        no_return_++;
    else
        scan_.points.push_back(
            {position, intensity, static_cast<std::int32_t>(offset),
             static_cast<std::uint16_t>(std::max(ring, 0))});
}

Scan ScanBuilder::finish()
{
    if (last_ >= first_) scan_.end = scan_.stamp + last_;
    // One ring is as good as none: nothing can be learned from neighbours along it.
    scan_.rings = rings_ > 0 ? rings_ : last_ring_ > 0 ? last_ring_ + 1 : 0;
    scan_.already_undistorted = scan_.points.size() > 1 && first_ == last_;
    return std::move(scan_);
}
}  // namespace taut
