#pragma once

#include <deque>
#include <limits>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"
#include "taut/preintegration/Declipper.h"

namespace taut
{
/** Brings two streams together in time: holds each scan until the IMU reaches over its end, and
 * decides by the clock of the scans when to wait no longer. Holds at most the scans of that wait
 * once the estimation runs. Samples at the end of the sensor's range are put back on the way. */
class Synchronizer
{
 public:
    enum class Imu
    {
        Awaited,  //!< no sample yet
        Present,
        Silent,  //!< there were samples; none for as long as it is waited for
        Absent,  //!< the estimation runs without one
    };

    /** `wait` [s] of scans without a sample end the waiting. */
    Synchronizer(double wait, const ImuRange& range, WarningSink warn);

    void add(const ImuSample& sample);
    void add(Scan scan);

    /** No more data: nothing is waited for any more. Warns of a sensor that ended before the other.
     */
    void end();

    /** From now on no sample is waited for or taken. */
    void runWithoutImu();

    Imu imu() const { return imu_state_; }
    bool ended() const { return ended_; }

    const ImuSamples& samples() const { return imu_; }
    const std::deque<Scan>& scans() const { return scans_; }

    /** How many scans at the front need to wait for nothing. */
    std::size_t ready() const;

    /** True if the samples tell the motion from `begin` to `end`: the last one may be held for a
     * tenth of a second. */
    bool tell(Time begin, Time end) const;

    void popScan() { scans_.pop_front(); }

    /** Drops what no state after `t` needs. */
    void forgetScansBefore(Time t);
    void forgetSamplesBefore(Time t);

 private:
    void addComplete(const ImuSample& sample);
    void judgeSilence();

    double wait_;
    WarningSink warn_;
    Declipper declipper_;
    std::deque<Scan> scans_;
    ImuSamples imu_;
    Imu imu_state_ = Imu::Awaited;
    /** First sample after the last silence: what lies before is not interpolated with it. */
    Time imu_since_ = std::numeric_limits<Time>::min();
    Time first_scan_end_ = 0, last_scan_end_ = 0;
    bool any_scan_ = false, ended_ = false, late_reported_ = false;
};
}  // namespace taut
