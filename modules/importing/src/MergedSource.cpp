#include "MergedSource.h"

#include <utility>

namespace taut
{
MergedSource::MergedSource(std::string path, SensorStreams streams, WarningSink warn)
    : path_(std::move(path)), streams_(std::move(streams)), warn_(std::move(warn))
{
}

std::optional<ImportedItem> MergedSource::next()
{
    if (!std::exchange(started_, true))
    {
        if (streams_.next_sample) sample_ = streams_.next_sample();
        scan_ = streams_.next_scan();
    }
    if (sample_ && (!scan_ || sample_->t < scan_->end))
    {
        any_sample_ = true;
        return std::exchange(sample_, streams_.next_sample());
    }
    if (scan_)
    {
        scans_++;
        if (scan_->already_undistorted) undistorted_++;
        return std::exchange(scan_, streams_.next_scan());
    }
    checkEnd();
    return {};
}

std::vector<std::string> MergedSource::findings() const
{
    auto lines = streams_.findings;
    if (undistorted_ > 0)
        lines.push_back(
            std::to_string(undistorted_) + " of " + std::to_string(scans_) +
            " scans have no times of their points: they count as undistorted already");
    return lines;
}

void MergedSource::checkEnd()
{
    if (std::exchange(ended_, true)) return;
    if (streams_.next_sample && !any_sample_ && warn_)
        warn_({0, "no_imu", "no sample of an IMU in '" + path_ + "'"});
}
}  // namespace taut
