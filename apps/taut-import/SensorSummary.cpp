#include "SensorSummary.h"

#include <cmath>
#include <cstdio>

namespace taut
{
namespace
{
const double kStep = std::log(1.02);

double seconds(int bucket)
{
    return std::exp(bucket * kStep) * 1e-9;
}
}  // namespace

void SensorSummary::add(Time t)
{
    if (count_++ == 0) first_ = last_ = t;
    const Duration interval = t - last_;
    last_ = t;
    if (interval <= 0) return;
    intervals_[static_cast<int>(std::lround(std::log(static_cast<double>(interval)) / kStep))]++;
    if (interval <= longest_) return;
    longest_ = interval;
    longest_at_ = t - interval;
}

std::string SensorSummary::text() const
{
    if (count_ < 2) return std::to_string(count_);
    std::size_t below = 0, gaps = 0;
    double usual = 0;
    for (const auto& [bucket, n] : intervals_)
    {
        if (2 * below < count_ - 1) usual = seconds(bucket);
        below += n;
        if (seconds(bucket) > 2.5 * usual) gaps += n;
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
