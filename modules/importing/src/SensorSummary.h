#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "taut/core/Time.h"

namespace taut
{
/** Count, rate and gaps of one sensor, as its stamps tell. */
class SensorSummary
{
 public:
    /** Stamps in the order of time. */
    void add(Time t);

    std::size_t count() const { return count_; }
    Duration span() const { return last_ - first_; }

    /** "179 in 35.7 s at 5.0 Hz, no gap"; a gap is longer than two and a half of the usual
     * intervals. */
    std::string text() const;

 private:
    std::size_t count_ = 0;
    Time first_ = 0, last_ = 0;
    struct Intervals
    {
        std::size_t count = 0;
        double seconds = 0;  // of all of them
    };
    std::map<int, Intervals> intervals_;  // by size, in steps of 2 %
    Duration longest_ = 0;
    Time longest_at_ = 0;  // its begin
};
}  // namespace taut
