#include "SensorSummary.h"

#include <cmath>
#include <cstdio>

namespace taut
{
namespace
{
const double kStep = std::log(1.02);
}  // namespace

void SensorSummary::add(Time t)
{
    if (count_++ == 0) first_ = last_ = t;
    const Duration interval = t - last_;
    last_ = t;
    if (interval <= 0) return;
    auto& bucket =
        intervals_[static_cast<int>(std::lround(std::log(static_cast<double>(interval)) / kStep))];
    bucket.count++;
    bucket.seconds += toSeconds(interval);
    if (interval <= longest_) return;
    longest_ = interval;
    longest_at_ = t - interval;
}

std::string SensorSummary::text() const
{
    if (count_ < 2) return std::to_string(count_);
    std::size_t below = 0, gaps = 0;
    double usual = 0;  // the median, to the width of a bucket
    for (const auto& [size, bucket] : intervals_)
    {
        const double mean = bucket.seconds / static_cast<double>(bucket.count);
        if (2 * below < count_ - 1) usual = mean;
        below += bucket.count;
        if (mean > 2.5 * usual) gaps += bucket.count;
    }
    char text[200];
    int n = std::snprintf(
        text, sizeof text, "%zu in %.3f s at %.4g Hz, ", count_, toSeconds(span()), 1 / usual);
    if (gaps == 0)
        std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "no gap");
    else
        std::snprintf(
            text + n, sizeof text - static_cast<std::size_t>(n),
            "%zu gap%s, the longest of %.3f s after %.3f s", gaps, gaps == 1 ? "" : "s",
            toSeconds(longest_), toSeconds(longest_at_ - first_));
    return text;
}
}  // namespace taut
