#include "taut/rawlog/ScanBuilder.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace taut
{
namespace
{
constexpr Duration kLargestOffset = 2'000'000'000;  // fits 32 bits; no LiDAR sweeps that slowly
constexpr double kMostOutside = 0.01;               // of the points: more are no mistake
}  // namespace

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

/** Keeps the points in the fullest window of that length, if few are outside. */
void ScanBuilder::dropOutside(Duration longest)
{
    std::vector<Duration> offsets;
    for (const LidarPoint& p : scan_.points) offsets.push_back(p.offset);
    std::sort(offsets.begin(), offsets.end());
    std::size_t begin = 0, end = 0;  // of the fullest window
    for (std::size_t from = 0, to = 0; to < offsets.size(); from++)
    {
        while (to < offsets.size() && offsets[to] - offsets[from] <= longest) to++;
        if (to - from > end - begin) std::tie(begin, end) = std::tie(from, to);
    }
    const std::size_t outside = offsets.size() - (end - begin);
    if (begin == end ||
        static_cast<double>(outside) > kMostOutside * static_cast<double>(offsets.size()))
        return;
    outside_ = outside;
    first_ = offsets[begin];
    last_ = offsets[end - 1];
    const auto is_outside = [this](const LidarPoint& p)
    { return p.offset < first_ || p.offset > last_; };
    scan_.points.erase(
        std::remove_if(scan_.points.begin(), scan_.points.end(), is_outside), scan_.points.end());
}

Scan ScanBuilder::finish(Duration longest)
{
    if (last_ >= first_ && last_ - first_ > longest) dropOutside(longest);
    if (last_ >= first_) scan_.end = scan_.stamp + last_;
    // One ring is as good as none: nothing can be learned from neighbours along it.
    scan_.rings = rings_ > 0 ? rings_ : last_ring_ > 0 ? last_ring_ + 1 : 0;
    scan_.already_undistorted = scan_.points.size() > 1 && first_ == last_;
    return std::move(scan_);
}
}  // namespace taut
