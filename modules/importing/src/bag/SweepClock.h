#pragma once

#include <optional>
#include <string>
#include <vector>

#include "RawSweep.h"
#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"

namespace taut::bag
{
/** Judges from the first sweeps of a bag what the times of their points and their stamps mean, and
 * turns sweeps to scans accordingly. */
class SweepClock
{
 public:
    SweepClock(ScanStamp asked, WarningSink warn) : asked_(asked), warn_(std::move(warn)) {}

    /** To be called once, with some sweeps of the beginning. Throws std::runtime_error if the times
     * cannot be those of sweeps in any unit. */
    void learn(const std::vector<const RawSweep*>& sweeps);

    /** The points at their own times, the stamp at the first of them. Points without a time of
     * the sweep are left out. Throws std::runtime_error if none has a time, unlike before. */
    Scan toScan(RawSweep sweep) const;

    /** What was judged, a line each. */
    const std::vector<std::string>& findings() const { return findings_; }

    /** See ImportSource. */
    std::optional<Duration> arrivalDelay() const { return arrival_delay_; }

 private:
    /** Where a sweep lies in time: its first and last point [ns]. */
    struct Extent
    {
        Time first = 0, last = 0;
    };
    /** How the times of the points become times of the header's clock. */
    enum class Anchor
    {
        None,        //!< they are
        FirstPoint,  //!< the header's stamp is the time of the first point
        LastPoint
    };

    void learnUnit(const std::vector<const RawSweep*>& sweeps);
    void learnAnchor(const std::vector<const RawSweep*>& sweeps);
    void anchorByArrival(const std::vector<const RawSweep*>& sweeps, Duration span);
    void checkArrival(const std::vector<const RawSweep*>& sweeps, Duration span);
    Time timeOf(const RawSweep& sweep, double value) const;
    void setTimes(Scan& scan, const RawSweep& sweep) const;
    Extent extentOf(const RawSweep& sweep) const;

    ScanStamp asked_;
    WarningSink warn_;
    bool timed_ = false;
    bool since_header_ = false;  //!< the points' times count from the header's stamp
    double unit_ = 1;            //!< of the points' times [ns]
    Anchor anchor_ = Anchor::None;
    std::optional<Duration> arrival_delay_;  // of sweeps whose points have no times
    std::vector<std::string> findings_;
};
}  // namespace taut::bag
