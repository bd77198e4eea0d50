#include "Synchronizer.h"

#include <algorithm>

#include "gaps.h"
#include "taut/core/format.h"

namespace taut
{
Synchronizer::Synchronizer(double wait, const ImuRange& range, WarningSink warn)
    : wait_(wait), warn_(std::move(warn)), declipper_(range, warn_)
{
}

void Synchronizer::add(const ImuSample& sample)
{
    for (const ImuSample& complete : declipper_.add(sample)) addComplete(complete);
}

void Synchronizer::addComplete(const ImuSample& sample)
{
    if (imu_state_ == Imu::Absent)
    {
        if (!late_reported_ && warn_)
            warn_(
                {sample.t, "late_imu",
                 "IMU samples appear after the estimation has started without them: ignored"});
        late_reported_ = true;
        return;
    }
    if (imu_state_ == Imu::Silent)
    {
        if (warn_)
            warn_(
                {sample.t, "imu_back",
                 format(
                     "IMU samples come again, %.2f s after the last one: they are used",
                     toSeconds(sample.t - imu_.back().t))});
        imu_.clear();
        imu_since_ = sample.t;
    }
    else if (!imu_.empty() && toSeconds(sample.t - imu_.back().t) > kImuGap && warn_)
    {
        warn_(
            {imu_.back().t, "imu_gap",
             format("no IMU sample for %.3f s", toSeconds(sample.t - imu_.back().t))});
    }
    imu_state_ = Imu::Present;
    imu_.push_back(sample);
}

void Synchronizer::add(Scan scan)
{
    if (!any_scan_) first_scan_end_ = scan.end;
    any_scan_ = true;
    last_scan_end_ = std::max(last_scan_end_, scan.end);
    scans_.push_back(std::move(scan));
    judgeSilence();
}

void Synchronizer::judgeSilence()
{
    if (imu_state_ == Imu::Awaited && toSeconds(last_scan_end_ - first_scan_end_) >= wait_)
    {
        if (warn_)
            warn_(
                {first_scan_end_, "no_imu",
                 format(
                     "no IMU sample in the first %.1f s of scans: the motion between scans is "
                     "taken as constant velocity instead",
                     wait_)});
        runWithoutImu();
    }
    if (imu_state_ == Imu::Present && toSeconds(last_scan_end_ - imu_.back().t) >= wait_)
    {
        imu_state_ = Imu::Silent;
        if (warn_)
            warn_(
                {imu_.back().t, "imu_silent",
                 format("no IMU sample for %.1f s", wait_) +
                     ": the motion between scans is taken as constant velocity until one comes"});
    }
}

void Synchronizer::end()
{
    for (const ImuSample& complete : declipper_.finish()) addComplete(complete);
    ended_ = true;
    if (imu_state_ == Imu::Awaited && !scans_.empty())
    {
        if (warn_)
            warn_(
                {first_scan_end_, "no_imu",
                 "the recording has no IMU sample: constant velocity instead"});
        runWithoutImu();
    }
    if (imu_.empty() || !any_scan_ || !warn_) return;
    const double without_scans = toSeconds(imu_.back().t - last_scan_end_);
    const double without_imu = toSeconds(last_scan_end_ - imu_.back().t);
    if (without_scans > kLidarGap)
        warn_(
            {last_scan_end_, "lidar_ended",
             format("no scan in the last %.2f s of the recording", without_scans)});
    if (imu_state_ == Imu::Present && without_imu > kImuGap)
        warn_(
            {imu_.back().t, "imu_silent",
             format("no IMU sample in the last %.2f s of the scans", without_imu)});
}

void Synchronizer::runWithoutImu()
{
    imu_state_ = Imu::Absent;
}

std::size_t Synchronizer::ready() const
{
    if (imu_state_ == Imu::Awaited) return 0;
    if (imu_state_ != Imu::Present || ended_) return scans_.size();
    std::size_t n = 0;
    while (n < scans_.size() && imu_.back().t >= scans_[n].end) n++;
    return n;
}

bool Synchronizer::tell(Time begin, Time end) const
{
    if (imu_.empty()) return false;
    return imu_since_ <= begin && end <= imu_.back().t + fromSeconds(kImuGap);
}

void Synchronizer::forgetScansBefore(Time t)
{
    while (!scans_.empty() && scans_.front().end <= t) scans_.pop_front();
}

void Synchronizer::forgetSamplesBefore(Time t)
{
    // But for the one to interpolate with.
    const auto keep = std::lower_bound(
        imu_.begin(), imu_.end(), t, [](const ImuSample& s, Time at) { return s.t < at; });
    if (keep - imu_.begin() > 1) imu_.erase(imu_.begin(), keep - 1);
}
}  // namespace taut
