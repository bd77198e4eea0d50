#include "taut/rawlog/StampOrder.h"

#include <algorithm>
#include <cstdlib>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr Duration kDisorder = 1'000'000'000;      // in which samples are sorted
constexpr Duration kGap = kDisorder;               // more than that needs a look at what follows
constexpr Duration kSmallestStep = kDisorder / 2;  // of a clock: two sweeps and more at 5 Hz
constexpr Duration kUsualStep = kDisorder / 2;     // of elapsed(), at most
constexpr std::size_t kNeighbours = 3;
constexpr std::size_t kMostPending = 20'000;  // whatever the stamps say
constexpr Duration kUnknownInterval = 10'000'000;

Duration intervalOf(const std::deque<Time>& history)
{
    std::vector<Duration> intervals;
    for (std::size_t i = 1; i < history.size(); i++)
        intervals.push_back(history[i] - history[i - 1]);
    if (intervals.empty()) return kUnknownInterval;
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    return *middle;
}

/** True if most of those after it are earlier. */
template <class Entries>
bool isAhead(const Entries& own, std::size_t at)
{
    const auto after = own.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    const auto behind =
        std::count_if(after, own.end(), [&](const auto* entry) { return entry->t < own[at]->t; });
    return 2 * behind > own.end() - after;
}
}  // namespace

std::size_t StampOrder::push(Sensor sensor, Time t)
{
    Stream& stream = streamOf(sensor);
    if (stream.pushed) stream.elapsed += std::clamp<Duration>(t - *stream.pushed, 0, kUsualStep);
    Entry entry{next_id_, sensor, t, {streams_[0].elapsed, streams_[1].elapsed}, false, false};
    entry.descends = stream.peak && t < *stream.peak;
    stream.after_descent = entry.descends ? 0 : stream.after_descent + 1;
    stream.pushed = t;
    stream.peak = std::max(stream.peak.value_or(t), t);
    stream.pending++;
    stream.descents += entry.descends ? 1 : 0;
    queue_.push_back(entry);
    return next_id_++;
}

std::optional<Duration> StampOrder::interval(Sensor sensor) const
{
    std::deque<Time> stamps = streams_[static_cast<std::size_t>(sensor)].history;
    for (const Entry& entry : queue_)
        if (entry.sensor == sensor && !entry.taken) stamps.push_back(entry.t);
    if (stamps.size() <= kNeighbours) return {};
    return intervalOf(stamps);
}

Duration StampOrder::elapsed() const
{
    return std::max(streams_[0].elapsed, streams_[1].elapsed);
}

bool StampOrder::ready() const
{
    if (queue_.empty()) return false;
    const Entry& front = queue_.front();
    if (judge_ == Judge::AtOnce && follows(front)) return true;
    const auto own = static_cast<std::size_t>(front.sensor);
    const auto since = [&](std::size_t i) { return streams_[i].elapsed - front.elapsed[i]; };
    const bool settled = streams_[own].descents == 0 || streams_[own].after_descent >= kNeighbours;
    return (streams_[own].pending > kNeighbours && settled && since(own) >= kDisorder) ||
           std::max(since(0), since(1)) >= 2 * kDisorder || queue_.size() >= kMostPending;
}

std::optional<StampOrder::Judged> StampOrder::pop()
{
    if (queue_.empty()) return {};
    Entry& front = queue_.front();
    Stream& stream = streamOf(front.sensor);
    if (follows(front)) return give(front, Verdict::Good, 0);

    const Entries own = pendingOf(front.sensor);
    if (isOutlier(own))
        return give(front, Verdict::Outlier, front.t - (stream.last ? *stream.last : own.at(1)->t));
    if (stream.last && front.t <= *stream.last &&
        (isSetBack(own, 0, *stream.last) || stepsAsTheOther(front)))
        return give(front, Verdict::SetBack, stepOf(front));
    if (front.sensor == Sensor::Imu)
        if (Entry* late = lateOne(own)) return give(*late, Verdict::Sorted, front.t - late->t);
    return give(front, Verdict::Good, 0);
}

/** Within a second after the one before, and nothing that is pending casts a doubt on it. */
bool StampOrder::follows(const Entry& front) const
{
    const Stream& stream = streams_[static_cast<std::size_t>(front.sensor)];
    return stream.last && front.t > *stream.last && front.t <= *stream.last + kGap &&
           stream.descents == (front.descends ? 1u : 0u);
}

StampOrder::Entries StampOrder::pendingOf(Sensor sensor)
{
    Entries own;
    for (Entry& entry : queue_)
        if (entry.sensor == sensor && !entry.taken) own.push_back(&entry);
    return own;
}

/** Of the first of its sensor that are pending. */
bool StampOrder::isOutlier(const Entries& own) const
{
    const Entry& front = *own.front();
    const Stream& stream = streams_[static_cast<std::size_t>(front.sensor)];
    if (stream.last) return front.t > *stream.last + kGap && isAhead(own, 0);
    if (own.size() <= kNeighbours) return false;
    return isAhead(own, 0) || (own[1]->t > front.t + kGap && !isAhead(own, 1));
}

/** Whether the clock was set back before own[at], up to which the latest stamp was `peak`: what
 * follows stays behind it, and tells times that were told already. */
bool StampOrder::isSetBack(const Entries& own, std::size_t at, Time peak) const
{
    const Duration back = peak - own[at]->t;
    if (back < kSmallestStep) return false;
    std::size_t end = at;
    Time latest = own[at]->t;
    for (; end < own.size() && own[end]->t <= peak; end++) latest = std::max(latest, own[end]->t);
    const std::size_t run = end - at;
    if (run < kNeighbours) return false;
    if (back > kDisorder) return 2 * run > own.size() - at;
    const auto covers = [&](Time t) { return own[at]->t <= t && t <= latest; };
    const auto& history = streams_[static_cast<std::size_t>(own[at]->sensor)].history;
    auto told = std::count_if(history.begin(), history.end(), covers);
    for (std::size_t i = 0; i < at; i++) told += covers(own[i]->t) ? 1 : 0;
    return 2 * static_cast<std::size_t>(told) >= run;
}

/** What the other sensor's clock was set back by, and this one's not yet. */
Duration StampOrder::behindTheOther(Sensor sensor) const
{
    const auto own = static_cast<std::size_t>(sensor);
    return streams_[1 - own].shift - streams_[own].shift;
}

bool StampOrder::stepsAsTheOther(const Entry& entry) const
{
    const Stream& stream = streams_[static_cast<std::size_t>(entry.sensor)];
    const Duration interval = intervalOf(stream.history);
    const Duration step = behindTheOther(entry.sensor);
    return step >= kSmallestStep && std::abs(*stream.last + interval - entry.t - step) <= interval;
}

Duration StampOrder::stepOf(const Entry& entry) const
{
    const Stream& stream = streams_[static_cast<std::size_t>(entry.sensor)];
    const Duration step = *stream.last + intervalOf(stream.history) - entry.t;
    const Duration other = behindTheOther(entry.sensor);
    return std::abs(other - step) < kSmallestStep ? other : step;
}

/** The earliest of those pending that belong before the first of them. */
StampOrder::Entry* StampOrder::lateOne(const Entries& own) const
{
    const Time first = own.front()->t;
    const auto& last = streams_[static_cast<std::size_t>(own.front()->sensor)].last;
    Entry* late = nullptr;
    Time peak = first;
    for (std::size_t i = 1; i < own.size(); i++)
    {
        const Time t = own[i]->t;
        if (t > peak)
        {
            if (t <= peak + kGap || !isAhead(own, i)) peak = t;
            continue;
        }
        const bool too_few = own.size() - i < kNeighbours;
        if (peak - t >= kSmallestStep && (too_few || isSetBack(own, i, peak))) break;
        if (t < first - kDisorder || t >= first || (last && t <= *last)) continue;
        if (late == nullptr || t < late->t) late = own[i];
    }
    return late;
}

StampOrder::Judged StampOrder::give(Entry& entry, Verdict verdict, Duration amount)
{
    Stream& stream = streamOf(entry.sensor);
    if (verdict == Verdict::SetBack)
    {
        stream.shift += amount;
        stream.history.clear();
        stream.last.reset();
    }
    if (verdict != Verdict::Outlier && (!stream.last || entry.t > *stream.last))
    {
        stream.last = entry.t;
        stream.history.push_back(entry.t);
        while (stream.history.front() < entry.t - kDisorder) stream.history.pop_front();
    }
    stream.pending--;
    stream.descents -= entry.descends ? 1 : 0;
    entry.taken = true;
    if (stream.peak == entry.t)
    {
        stream.peak.reset();
        for (const Entry* other : pendingOf(entry.sensor))
            stream.peak = std::max(stream.peak.value_or(other->t), other->t);
    }
    const Judged judged{entry.id, verdict, stream.shift, amount};
    while (!queue_.empty() && queue_.front().taken) queue_.pop_front();
    return judged;
}

StampFinding findingOf(const StampOrder::Judged& judged, const std::string& what)
{
    const double seconds = toSeconds(judged.amount);
    if (judged.verdict == StampOrder::Verdict::Outlier)
        return {
            "stamp_outlier", format(
                                 "the stamp of %s is %.6f s %s those around it", what.c_str(),
                                 std::abs(seconds), seconds > 0 ? "ahead of" : "behind")};
    if (judged.verdict == StampOrder::Verdict::Sorted)
        return {
            "imu_order", format("%s comes %.6f s late in the file: sorted", what.c_str(), seconds)};
    return {
        "clock_back", format(
                          "the clock was set back by %.6f s before %s: later stamps are moved by "
                          "as much, so that time goes on",
                          seconds, what.c_str())};
}
}  // namespace taut
