#include "SweepStamps.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace taut
{
namespace
{
constexpr Time kYear2000 = 946'684'800'000'000'000;
constexpr Duration kSecond = 1'000'000'000;
constexpr Duration kClose = kSecond / 2;
}  // namespace

void SweepStamps::decide(Time t, Time captured)
{
    if (decided_) return;
    decided_ = true;
    ahead_ = t - captured;
    by_capture_ = clock_ == StampClock::Capture ||
                  (clock_ == StampClock::SensorIfClose && std::abs(ahead_) > kClose);
    // A clock that counts from the sensor's start.
    if (!by_capture_ && t < kYear2000) shift_ = (captured - t + kSecond / 2) / kSecond * kSecond;
}

void SweepStamps::note(Time t, Time captured)
{
    decide(t, captured);
    shortest_ = std::min(shortest_.value_or(captured - t), captured - t);
}

Time SweepStamps::of(Time t, Time captured)
{
    decide(t, captured);
    return by_capture_ ? captured : t + shift_;
}

void SweepStamps::apply(Scan& scan)
{
    const Duration shift = by_capture_ ? shortest_.value_or(-ahead_) : shift_;
    scan.stamp += shift;
    scan.end += shift;
    shortest_.reset();
}

std::string SweepStamps::finding() const
{
    if (clock_ == StampClock::Capture) return "stamps: when the capture says";
    char text[160];
    if (by_capture_)
        std::snprintf(
            text, sizeof text,
            "stamps: when the packets were taken; the sensor's clock is %.3f s %s",
            std::abs(toSeconds(ahead_)), ahead_ > 0 ? "ahead" : "behind");
    else if (shift_ == 0)
        return "stamps: the sensor's clock";
    else
        std::snprintf(
            text, sizeof text,
            "stamps: the sensor's clock, which counts from its start, put on the day of the "
            "capture: %.0f s added",
            toSeconds(shift_));
    return text;
}
}  // namespace taut
