#pragma once

#include <cstddef>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** Intervals of a stream, in memory that does not grow with it: a histogram of 2 % resolution, and
 * the largest with their times. */
class IntervalStatistics
{
 public:
    struct Interval
    {
        Time begin = 0;
        Duration length = 0;
    };

    IntervalStatistics();

    /** Intervals of zero or less count as the shortest. */
    void add(Time begin, Duration length);

    std::size_t count() const { return count_; }
    /** [s]; 0 if there is none. */
    double median() const;
    /** Intervals shorter, or longer, than that [s]. */
    std::size_t shorter(double seconds) const;
    std::size_t longer(double seconds) const;
    /** The largest few, longest first. */
    const std::vector<Interval>& largest() const { return largest_; }

 private:
    struct Bin
    {
        std::size_t count = 0;
        double sum = 0;  //!< [s]
    };
    static std::size_t binOf(double seconds);
    std::size_t countBetween(std::size_t begin, std::size_t end) const;

    std::vector<Bin> bins_;
    std::vector<Interval> largest_;
    std::size_t count_ = 0;
};
}  // namespace taut
