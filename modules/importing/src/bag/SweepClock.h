#pragma once

#include <optional>
#include <string>
#include <vector>

#include "RawSweep.h"
#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"

namespace taut::bag
{
/** Judges from the first sweeps of a recording what the times of their points and their stamps
 * mean, and turns sweeps to scans accordingly. Most points and most sweeps decide, never a single
 * one. */
class SweepClock
{
 public:
    SweepClock(ScanStamp asked, WarningSink warn) : asked_(asked), warn_(std::move(warn)) {}

    /** To be called once, with some sweeps of the beginning. Throws std::runtime_error if the times
     * cannot be those of sweeps in any unit, or are too coarse to undistort by. */
    void learn(const std::vector<const RawSweep*>& sweeps);

    /** Whether a sweep whose message has no stamp (0) can be placed in time all the same. */
    bool knowsTimesWithoutStamps() const
    {
        return timed_ && !since_header_ && anchor_ == Anchor::None;
    }

    /** The points at their own times, the stamp at the first of them. Points without a time of
     * the sweep are left out. Throws std::runtime_error if none has a time, unlike before. */
    Scan toScan(RawSweep sweep);

    /** What was judged, a line each, and how many points were left out. */
    std::vector<std::string> findings() const;

    /** See ImportSource. */
    std::optional<Duration> arrivalDelay() const { return arrival_delay_; }

 private:
    /** Where a sweep lies in time: its first and last point [ns]. */
    struct Extent
    {
        Time first = 0, last = 0;

        bool covers(Time t) const { return first <= t && t <= last; }
    };
    /** How the times of the points become times of the header's clock. */
    enum class Anchor
    {
        None,        //!< they are
        FirstPoint,  //!< the header's stamp is the time of the first point
        LastPoint
    };

    void learnUnit(const std::vector<const RawSweep*>& sweeps);
    void checkPrecision(const RawSweep& sweep, double span) const;
    void learnLongest(const std::vector<const RawSweep*>& sweeps);
    void learnBase(const std::vector<const RawSweep*>& sweeps);
    void learnAnchor(const std::vector<const RawSweep*>& sweeps);
    void anchorByArrival(const std::vector<const RawSweep*>& sweeps, Duration span);
    void checkArrival(const std::vector<const RawSweep*>& sweeps, Duration span);
    Time timeOf(const RawSweep& sweep, double value) const;
    void setTimes(Scan& scan, const RawSweep& sweep) const;
    Extent extentOf(const RawSweep& sweep) const;
    Extent extentOf(const std::vector<Time>& times, Time middle) const;

    ScanStamp asked_;
    WarningSink warn_;
    bool timed_ = false;
    bool since_header_ = false;              //!< the points' times count from the header's stamp
    double unit_ = 1;                        //!< of the points' times [ns]
    Duration longest_ = 0;                   //!< a sweep, as far as can be told
    std::size_t points_ = 0, left_out_ = 0;  //!< for their times
    Anchor anchor_ = Anchor::None;
    std::optional<Duration> arrival_delay_;  // of sweeps whose points have no times
    std::vector<std::string> findings_;
};
}  // namespace taut::bag
