#include "SweepClock.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace taut::bag
{
namespace
{
constexpr Duration kLongestSweep = 2'000'000'000;
constexpr Duration kLargestOverlap = 20'000'000;  // of sweeps, by jitter
constexpr double kMostOutside = 0.05;             // of the points of a sweep: more are no mistake
constexpr double kFinestFloat = 1e6;   // [ns] steps of a float that are told from a lack of digits
constexpr double kCoarsestStep = 3e6;  // [ns] any other
constexpr std::size_t kManyPoints = 1000;  // that tell steps
constexpr double kLargestTime = 2.2e18;    // ns: twice that and a stamp are within 64 bits

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

/** What the points of a sweep are spread over, whatever 1 of 20 at either end says. */
double spanOf(const RawSweep& sweep)
{
    std::vector<double> times = sweep.times;
    const std::size_t last = times.size() - 1, cut = times.size() / 20;
    const auto at = [&](std::size_t i)
    {
        const auto place = times.begin() + static_cast<std::ptrdiff_t>(i);
        std::nth_element(times.begin(), place, times.end());
        return *place;
    };
    const double inner = at(last - cut) - at(cut);
    return inner * static_cast<double>(last) / static_cast<double>(last - 2 * cut);
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
    std::size_t with_points = 0;
    bool has_field = false;
    for (const RawSweep* sweep : all)
    {
        has_field |= !sweep->time_field.empty();
        with_points += sweep->times.size() > 1 ? 1 : 0;
        if (sweep->times.size() > 1 && spanOf(*sweep) > 0) sweeps.push_back(sweep);
    }
    timed_ = sweeps.size() >= std::min<std::size_t>(2, std::max<std::size_t>(1, with_points));
    if (timed_)
    {
        learnUnit(sweeps);
        learnLongest(sweeps);
        learnBase(sweeps);
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
                "the times of a sweep's points, " + sweeps.front()->time_field + ", differ by " +
                std::to_string(span) + ", which is no duration of a sweep in any unit");
    }
    checkPrecision(*sweeps.front(), span);
    findings_.push_back(
        "times of the points: " + sweeps.front()->time_field + " in " + unitName(unit_) +
        (nominal > 0 && nominal != unit_ ? ", not in " + std::string(unitName(nominal)) +
                                               " as usual, for a sweep has " + std::to_string(span)
                                         : "") +
        "; a sweep has " + milliseconds(span * unit_));
}

/** Undistortion needs the time of a point to a small part of a sweep. */
void SweepClock::checkPrecision(const RawSweep& sweep, double span) const
{
    double step = 0;
    if (sweep.single_precision)
    {
        const auto usual = static_cast<float>(median(sweep.times));
        step = std::nextafter(usual, std::numeric_limits<float>::infinity()) - usual;
    }
    else if (sweep.times.size() >= kManyPoints)
    {
        std::vector<double> steps = sweep.times;
        std::sort(steps.begin(), steps.end());
        steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
        step = span / static_cast<double>(steps.size());
    }
    if (step * unit_ <= (sweep.single_precision ? kFinestFloat : kCoarsestStep)) return;
    throw std::runtime_error(
        "the times of the points, " + sweep.time_field + ", come in steps of " +
        milliseconds(step * unit_) +
        ", too coarse to undistort by: record them as float64, or counted from the stamp. "
        "--time-field none imports the sweeps as if they had no times");
}

/** A sweep ends before the next begins: what is longer has points with a wrong time. */
void SweepClock::learnLongest(const std::vector<const RawSweep*>& sweeps)
{
    std::vector<Duration> intervals, spans;
    for (std::size_t i = 0; i < sweeps.size(); i++)
    {
        spans.push_back(std::llround(spanOf(*sweeps[i]) * unit_));
        const Duration interval = i > 0 ? sweeps[i]->header - sweeps[i - 1]->header : 0;
        if (interval > 0 && interval < kLongestSweep) intervals.push_back(interval);
    }
    const Duration span = median(std::move(spans));
    longest_ = 2 * intervals.size() < sweeps.size()
                   ? span + span / 2
                   : std::max(median(std::move(intervals)) + kLargestOverlap, span + span / 5);
}

/** Whether the times count from the stamp. */
void SweepClock::learnBase(const std::vector<const RawSweep*>& sweeps)
{
    std::vector<double> middles;
    double last = 0;
    bool has_base = false, runs = sweeps.size() > 1;  // on, from sweep to sweep
    std::size_t headers = 0;
    for (const RawSweep* sweep : sweeps)
    {
        headers += sweep->header != 0 ? 1 : 0;
        if (sweep != sweeps.front()) runs &= median(sweep->times) > last;
        last = median(sweep->times);
        middles.push_back(std::abs(median(sweep->times)));
        has_base |= sweep->base != 0;
    }
    since_header_ = !has_base && !(runs && headers == 0) &&
                    median(std::move(middles)) * unit_ < static_cast<double>(kLongestSweep);
}

void SweepClock::learnAnchor(const std::vector<const RawSweep*>& sweeps)
{
    std::vector<double> places;
    std::vector<Duration> spans;
    for (const RawSweep* sweep : sweeps)
    {
        const Extent extent = extentOf(*sweep);
        spans.push_back(extent.last - extent.first);
        if (sweep->header == 0) continue;
        places.push_back(
            static_cast<double>(sweep->header - extent.first) /
            static_cast<double>(std::max<Duration>(spans.back(), 1)));
    }
    const Duration span = median(std::move(spans));
    if (2 * places.size() < sweeps.size() && !since_header_)
    {
        findings_.emplace_back(
            "stamp of a sweep: most have none, and the times of the points are used instead");
        return;
    }
    const double place = places.empty() ? 0 : median(std::move(places));
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
    std::vector<Time> times;
    for (const double value : sweep.times) times.push_back(timeOf(sweep, value));
    return extentOf(times, timeOf(sweep, median(sweep.times)));
}

/** Without what is far from the middle, nor what is outside of the fullest stretch that a sweep can
 * be long, if that is little: a cloud may well be of two turns. */
SweepClock::Extent SweepClock::extentOf(const std::vector<Time>& times, Time middle) const
{
    Extent near{middle, middle};
    for (const Time t : times)
    {
        if (std::abs(t - middle) > kLongestSweep / 2) continue;
        near.first = std::min(near.first, t);
        near.last = std::max(near.last, t);
    }
    if (near.last - near.first <= longest_) return near;
    std::vector<Time> sorted;
    for (const Time t : times)
        if (near.covers(t)) sorted.push_back(t);
    std::sort(sorted.begin(), sorted.end());
    std::size_t begin = 0, end = 0;  // of the fullest stretch
    for (std::size_t from = 0, to = 0; to < sorted.size(); from++)
    {
        while (to < sorted.size() && sorted[to] - sorted[from] <= longest_) to++;
        if (to - from <= end - begin) continue;
        begin = from;
        end = to;
    }
    const std::size_t outside = sorted.size() - (end - begin);
    if (end == 0 ||
        static_cast<double>(outside) > kMostOutside * static_cast<double>(sorted.size()))
        return near;
    return {sorted[begin], sorted[end - 1]};
}

std::vector<std::string> SweepClock::findings() const
{
    std::vector<std::string> all = findings_;
    if (left_out_ > 0)
        all.push_back(
            std::to_string(left_out_) + " of " + std::to_string(points_) +
            " points have a time outside of their sweep and are left out");
    return all;
}

Scan SweepClock::toScan(RawSweep sweep)
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
    points_ += all;
    left_out_ += lost;
    if (20 * lost > all && warn_)
        warn_(
            {scan.stamp, "scan_bad_points",
             std::to_string(lost) + " of " + std::to_string(all) +
                 " points have an impossible time and are left out"});
    return scan;
}

void SweepClock::setTimes(Scan& scan, const RawSweep& sweep) const
{
    std::vector<Time> times;
    for (const double value : sweep.times) times.push_back(timeOf(sweep, value));
    const Extent extent = extentOf(times, timeOf(sweep, median(sweep.times)));
    const Time first = extent.first;
    for (std::size_t i = 0; i < times.size(); i++)
        if (extent.covers(times[i]))
        {
            scan.points.push_back(sweep.points[i]);
            scan.points.back().offset = static_cast<std::int32_t>(times[i] - first);
        }
    const Duration span = extent.last - first;
    scan.stamp = anchor_ == Anchor::None         ? first
                 : anchor_ == Anchor::FirstPoint ? sweep.header
                                                 : sweep.header - span;
    scan.end = scan.stamp + span;
    scan.already_undistorted = span == 0 && scan.points.size() > 1;
}
}  // namespace taut::bag
