#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>

#include "taut/core/Scan.h"

namespace taut
{
/** Remembers when each scan was whole, until it is asked for. Thread-safe. */
class ScanAges
{
 public:
    using Clock = std::chrono::steady_clock;

    /** `clock_offset` [s]: what the rig adds to the stamps of the LiDAR. */
    explicit ScanAges(double clock_offset) : clock_offset_(fromSeconds(clock_offset)) {}

    void add(Time stamp, Clock::time_point whole);

    /** [s] since the scan was whole; nothing if it is not known, as after a clock that was set
     * back. Forgets the scans up to that one. */
    std::optional<double> of(const Scan& scan);

 private:
    Duration clock_offset_;
    std::mutex mutex_;
    std::map<Time, Clock::time_point> whole_;
};
}  // namespace taut
