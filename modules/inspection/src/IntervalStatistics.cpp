#include "taut/inspection/IntervalStatistics.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kShortest = 1e-6;  // [s]
constexpr double kRatio = 1.02;     // of neighbouring bins
constexpr std::size_t kBins = 1400;
constexpr std::size_t kLargest = 5;
}  // namespace

IntervalStatistics::IntervalStatistics() : bins_(kBins) {}

std::size_t IntervalStatistics::binOf(double seconds)
{
    if (seconds <= kShortest) return 0;
    const double bin = std::log(seconds / kShortest) / std::log(kRatio);
    return std::min(kBins - 1, static_cast<std::size_t>(bin));
}

void IntervalStatistics::add(Time begin, Duration length)
{
    const double seconds = toSeconds(length);
    Bin& bin = bins_[binOf(seconds)];
    bin.count++;
    bin.sum += seconds;
    count_++;
    if (largest_.size() == kLargest && length <= largest_.back().length) return;
    const auto place = std::upper_bound(
        largest_.begin(), largest_.end(), length,
        [](Duration l, const Interval& i) { return l > i.length; });
    largest_.insert(place, {begin, length});
    if (largest_.size() > kLargest) largest_.pop_back();
}

double IntervalStatistics::median() const
{
    std::size_t seen = 0;
    for (const Bin& bin : bins_)
    {
        seen += bin.count;
        if (2 * seen > count_) return bin.sum / static_cast<double>(bin.count);
    }
    return 0;
}

std::size_t IntervalStatistics::countBetween(std::size_t begin, std::size_t end) const
{
    std::size_t n = 0;
    for (std::size_t i = begin; i < end; i++) n += bins_[i].count;
    return n;
}

std::size_t IntervalStatistics::shorter(double seconds) const
{
    return countBetween(0, binOf(seconds));
}

std::size_t IntervalStatistics::longer(double seconds) const
{
    return countBetween(binOf(seconds) + 1, kBins);
}
}  // namespace taut
