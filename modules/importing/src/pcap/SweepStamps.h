#pragma once

#include <optional>
#include <string>

#include "taut/importing/pcap/PacketDecoder.h"

namespace taut
{
/** Takes times by the clock of a sensor to the clock that is asked for. Times within a sweep stay
 * the sensor's. */
class SweepStamps
{
 public:
    explicit SweepStamps(StampClock clock) : clock_(clock) {}

    /** Looks at the clock of the sensor: `t` by it, `captured` by the computer. The first call
     * counts; note() and of() do the same. */
    void decide(Time t, Time captured);

    /** True if stamps are the computer's. */
    bool byCapture() const { return by_capture_; }

    /** A packet in the order of arrival, whose last measurement was at `t` by the sensor. */
    void note(Time t, Time captured);

    /** The stamp of a reading that travelled alone. */
    Time of(Time t, Time captured);

    /** Moves a sweep whose packets were noted; by the capture it ends when the packet with the
     * shortest way was captured. */
    void apply(Scan& scan);

    /** What the stamps are, for the summary. */
    std::string finding() const;

 private:
    StampClock clock_;
    bool decided_ = false, by_capture_ = false;
    Duration shift_ = 0;                // whole seconds to the day of the capture
    Duration ahead_ = 0;                // of the sensor's clock, at the first packet
    std::optional<Duration> shortest_;  // from measurement to capture in this sweep
};
}  // namespace taut
