#include "SweepClock.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace taut::bag
{
namespace
{
constexpr Duration kLongestSweep = 2'000'000'000;
constexpr double kLargestTime = 2.2e18;  // ns: twice that and a stamp are within 64 bits

template <class T>
T median(std::vector<T> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string milliseconds(double ns)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.3g ms", ns * 1e-6);
    return text;
}

const char* unitName(double unit)
{
    return unit == 1e9 ? "s" : unit == 1e6 ? "ms" : unit == 1e3 ? "us" : "ns";
}

/** A sweep takes 2 ms to 2 s: so its length in numbers tells the unit [ns]. */
double unitOf(double span)
{
    return span < 2 ? 1e9 : span < 2e3 ? 1e6 : span < 2e6 ? 1e3 : 1;
}

double spanOf(const RawSweep& sweep)
{
    const auto [least, most] = std::minmax_element(sweep.times.begin(), sweep.times.end());
    return *most - *least;
}

/** Usual time from the stamp to the arrival at the recorder; nothing if the recorder's time is a
 * copy of the stamp. */
std::optional<Duration> arrivalDelayOf(const std::vector<const RawSweep*>& sweeps)
{
    std::vector<Duration> delays;
    bool copied = true;
    for (const RawSweep* sweep : sweeps)
    {
        delays.push_back(sweep->received - sweep->header);
        copied &= std::abs(delays.back()) < 1000;
    }
    if (copied) return {};
    return median(std::move(delays));
}

bool plausible(double ns)
{
    return ns >= 2e6 && ns < static_cast<double>(kLongestSweep);
}
}  // namespace

void SweepClock::learn(const std::vector<const RawSweep*>& all)
{
    std::vector<const RawSweep*> sweeps;
    bool has_field = false;
    for (const RawSweep* sweep : all)
    {
        has_field |= !sweep->time_field.empty();
        if (sweep->times.size() > 1 && spanOf(*sweep) > 0) sweeps.push_back(sweep);
    }
    timed_ = !sweeps.empty();
    if (timed_)
    {
        learnUnit(sweeps);
        learnAnchor(sweeps);
        return;
    }
    if (has_field) findings_.emplace_back("the points of a sweep all have the same time");
    arrival_delay_ = arrivalDelayOf(all);
}

void SweepClock::learnUnit(const std::vector<const RawSweep*>& sweeps)
{
    std::vector<double> spans;
    for (const RawSweep* sweep : sweeps) spans.push_back(spanOf(*sweep));
    const double span = median(std::move(spans));
    const double nominal = sweeps.front()->nominal_unit;
    unit_ = nominal > 0 && plausible(span * nominal) ? nominal : unitOf(span);
    if (!plausible(span * unit_))
    {
        if (nominal > 0) unit_ = nominal;
        if (span * unit_ >= static_cast<double>(kLongestSweep))
            throw std::runtime_error(
                "the times of a sweep's points differ by " + std::to_string(span) +
                ", which is no duration of a sweep in any unit");
    }
    findings_.push_back(
        "times of the points: " + sweeps.front()->time_field + " in " + unitName(unit_) +
        (nominal > 0 && nominal != unit_ ? ", not in " + std::string(unitName(nominal)) +
                                               " as usual, for a sweep has " + std::to_string(span)
                                         : "") +
        "; a sweep has " + milliseconds(span * unit_));
}

void SweepClock::learnAnchor(const std::vector<const RawSweep*>& sweeps)
{
    const RawSweep& some = *sweeps.front();
    since_header_ =
        some.base == 0 && std::abs(some.times.front()) * unit_ < static_cast<double>(kLongestSweep);
    std::vector<double> places;
    std::vector<Duration> spans;
    for (const RawSweep* sweep : sweeps)
    {
        const Extent extent = extentOf(*sweep);
        spans.push_back(extent.last - extent.first);
        places.push_back(
            static_cast<double>(sweep->header - extent.first) /
            static_cast<double>(std::max<Duration>(spans.back(), 1)));
    }
    const double place = median(std::move(places));
    const Duration span = median(std::move(spans));
    if (asked_ != ScanStamp::Detect)
    {
        anchor_ = asked_ == ScanStamp::Start ? Anchor::FirstPoint : Anchor::LastPoint;
        findings_.push_back(
            "stamp of a sweep: taken as the time of its " +
            std::string(asked_ == ScanStamp::Start ? "first" : "last") + " point, as asked for");
    }
    else if (place > -0.5 && place < 1.5)
    {
        char share[60];
        std::snprintf(share, sizeof share, "at %.0f %% of it", 100 * place);
        findings_.push_back(
            "stamp of a sweep: " +
            std::string(
                std::abs(place) < 0.2       ? "its start"
                : std::abs(place - 1) < 0.2 ? "its end"
                                            : share) +
            ", as the times of the points tell");
        if (since_header_ && std::abs(place) < 0.2) checkArrival(sweeps, span);
    }
    else
        anchorByArrival(sweeps, span);
}

namespace
{
/** Time from the stamp to the arrival at the recorder, as a share of the sweep; nothing if the
 * recorder's time is a copy of the stamp or of another clock. */
std::optional<double> delayOf(const std::vector<const RawSweep*>& sweeps, Duration span)
{
    const auto delay = arrivalDelayOf(sweeps);
    const double share =
        static_cast<double>(delay.value_or(0)) / static_cast<double>(std::max<Duration>(span, 1));
    if (!delay || std::abs(share) > 5) return {};
    return share;
}
}  // namespace

/** The points have a clock of their own: which end of the sweep does the header's stamp mean? */
void SweepClock::anchorByArrival(const std::vector<const RawSweep*>& sweeps, Duration span)
{
    const auto delay = delayOf(sweeps, span);
    const bool is_end = delay && *delay < 0.5;
    anchor_ = is_end ? Anchor::LastPoint : Anchor::FirstPoint;
    const std::string text =
        "the times of the points are of another clock than the stamps of the messages: the stamps "
        "are used, as the time of the " +
        std::string(is_end ? "last" : "first") + " point";
    if (delay)
        findings_.push_back(
            text + ", for a sweep was recorded " +
            milliseconds(*delay * static_cast<double>(span)) + " after its stamp");
    else if (warn_)
        warn_(
            {sweeps.front()->header, "scan_stamp",
             text + "; nothing in the bag tells which end it is: --scan-stamp start or end says"});
}

/** A sweep cannot arrive before it was measured. */
void SweepClock::checkArrival(const std::vector<const RawSweep*>& sweeps, Duration span)
{
    const auto delay = delayOf(sweeps, span);
    if (delay && *delay > -0.1 && *delay < 0.7 && warn_)
        warn_(
            {sweeps.front()->header, "scan_stamp",
             "the times of the points count from the stamp up to " +
                 milliseconds(static_cast<double>(span)) + ", but sweeps were recorded " +
                 milliseconds(*delay * static_cast<double>(span)) +
                 " after it: if the stamp is the end of the sweep, --scan-stamp end corrects "
                 "that; if clocks differ, --scan-stamp start confirms it"});
}

Time SweepClock::timeOf(const RawSweep& sweep, double value) const
{
    // Damaged values: no overflow, and far from the others all the same.
    value = std::clamp(value, -kLargestTime / unit_, kLargestTime / unit_);
    const double whole = std::trunc(value);  // what a product would round of a time since 1970
    return (since_header_ ? sweep.header : sweep.base) +
           static_cast<Time>(whole) * static_cast<Time>(unit_) +
           std::llround((value - whole) * unit_);
}

SweepClock::Extent SweepClock::extentOf(const RawSweep& sweep) const
{
    const auto [least, most] = std::minmax_element(sweep.times.begin(), sweep.times.end());
    return {timeOf(sweep, *least), timeOf(sweep, *most)};
}

Scan SweepClock::toScan(RawSweep sweep) const
{
    Scan scan;
    scan.rings = sweep.rings;
    scan.stamp = scan.end = sweep.header;
    scan.already_undistorted = !timed_;
    if (!timed_)
        scan.points = std::move(sweep.points);
    else if (sweep.times.size() != sweep.points.size())
        throw std::runtime_error("its points have no times, unlike those before");
    else if (!sweep.points.empty())
        setTimes(scan, sweep);
    const std::size_t all = sweep.times.size() + sweep.bad_times;
    const std::size_t lost = timed_ ? all - scan.points.size() : 0;
    if (20 * lost > all && warn_)
        warn_(
            {scan.stamp, "scan_bad_points",
             std::to_string(lost) + " of " + std::to_string(all) +
                 " points have an impossible time and are left out"});
    return scan;
}

void SweepClock::setTimes(Scan& scan, const RawSweep& sweep) const
{
    const Time middle = timeOf(sweep, median(sweep.times));
    std::vector<Time> times;
    for (const double value : sweep.times) times.push_back(timeOf(sweep, value));
    const auto bad = [&](Time t) { return std::abs(t - middle) > kLongestSweep / 2; };
    Time first = middle, last = middle;
    for (const Time t : times)
        if (!bad(t))
        {
            first = std::min(first, t);
            last = std::max(last, t);
        }
    for (std::size_t i = 0; i < times.size(); i++)
        if (!bad(times[i]))
        {
            scan.points.push_back(sweep.points[i]);
            scan.points.back().offset = static_cast<std::int32_t>(times[i] - first);
        }
    const Duration span = last - first;
    scan.stamp = anchor_ == Anchor::None         ? first
                 : anchor_ == Anchor::FirstPoint ? sweep.header
                                                 : sweep.header - span;
    scan.end = scan.stamp + span;
    scan.already_undistorted = span == 0 && scan.points.size() > 1;
}
}  // namespace taut::bag
