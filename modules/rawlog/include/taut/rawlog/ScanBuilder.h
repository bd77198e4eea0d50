#pragma once

#include <cstddef>
#include <limits>

#include "taut/core/Scan.h"

namespace taut
{
/** Collects the points of one scan, drops those that cannot be used and counts why. */
class ScanBuilder
{
 public:
    /** `stamp` is the reference of the offsets. */
    ScanBuilder(Time stamp, std::size_t expected_points);

    void add(const Eigen::Vector3f& position, float intensity, Time t, int ring);

    /** Where the sensor is known; else the largest ring seen counts. */
    void setRings(int rings) { rings_ = rings; }

    /** The scan: end, rings and already_undistorted are set; the label and the pose are not. A
     * sweep does not take longer than `longest`: if it seems so by less than 1 % of its points,
     * these have a wrong time and are dropped. */
    Scan finish(Duration longest = std::numeric_limits<Duration>::max());

    std::size_t seen() const { return seen_; }
    std::size_t notFinite() const { return not_finite_; }  //!< a coordinate is NaN or infinite
    std::size_t noReturn() const { return no_return_; }    //!< at (0, 0, 0)
    std::size_t badTime() const { return bad_time_; }      //!< 2 s or more away from the stamp
    std::size_t outside() const { return outside_; }       //!< dropped by finish()

 private:
    void dropOutside(Duration longest);

    Scan scan_;
    std::size_t seen_ = 0, not_finite_ = 0, no_return_ = 0, bad_time_ = 0, outside_ = 0;
    Duration first_ = std::numeric_limits<Duration>::max();
    Duration last_ = std::numeric_limits<Duration>::min();
    int last_ring_ = -1, rings_ = 0;
};
}  // namespace taut
