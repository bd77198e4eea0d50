#pragma once

#include <optional>

namespace taut
{
/** Decides which share of each scan is used, so that the estimation keeps up with the sensor. All
 * decisions follow from what it is told; it has no clock of its own.
 *
 * The load is the time of the work for a scan over the interval between scans, smoothed over some
 * five scans. The share goes down one of the steps 1, 0.7, 0.5, 0.35, 0.25
 *  - if the load is above 0.9, or
 *  - if poses are more than two intervals late, were so ten scans before, and not much more then.
 * It goes up one step if at the share above, by proportion, the load would be below 0.7 and poses
 * are not late, for 5 s without a break. Where a step up had to be taken back within 10 s, the next
 * one takes twice as long, up to 80 s. Between two changes are at least ten scans. */
class LoadControl
{
 public:
    /** After each scan: the interval since the one before, the work for it, and how late its pose
     * was (where that is known), all in s. True if the share has changed. */
    bool add(double interval, double work, std::optional<double> late);

    double share() const;                  //!< (0, 1]
    double load() const { return load_; }  //!< smoothed

 private:
    bool mustDoLess(double interval, std::optional<double> late);
    bool mayDoMore(double interval, std::optional<double> late);

    int step_ = 0;
    double load_ = 0;
    bool begun_ = false;
    int since_change_ = 0, since_look_ = 0;  // scans
    std::optional<double> late_before_;      // when it was looked last
    double calm_ = 0, patience_ = 5;         // [s] below the bounds; [s] before a step up
    std::optional<double> since_more_;       // [s] since the last step up
};
}  // namespace taut
