#include "MergedSource.h"

#include <algorithm>
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
        if (sample_) sample_after_ = streams_.next_sample();
        scan_ = streams_.next_scan();
        if (scan_) scan_after_ = streams_.next_scan();
    }
    if (sampleIsDue())
    {
        any_sample_ = true;
        auto after = sample_after_ ? streams_.next_sample() : std::nullopt;
        return std::exchange(sample_, std::exchange(sample_after_, std::move(after)));
    }
    if (scan_)
    {
        scans_++;
        if (scan_->already_undistorted) undistorted_++;
        auto after = scan_after_ ? streams_.next_scan() : std::nullopt;
        return std::exchange(scan_, std::exchange(scan_after_, std::move(after)));
    }
    checkEnd();
    return {};
}

bool MergedSource::sampleIsDue() const
{
    if (!sample_ || !scan_) return sample_.has_value();
    const Time t = sample_after_ ? std::min(sample_->t, sample_after_->t) : sample_->t;
    return t < (scan_after_ ? std::min(scan_->end, scan_after_->end) : scan_->end);
}

std::vector<std::string> MergedSource::findings() const
{
    auto lines = streams_.findings;
    if (streams_.later_findings)
        for (std::string& line : streams_.later_findings()) lines.push_back(std::move(line));
    if (undistorted_ > 0)
        lines.push_back(
            std::to_string(undistorted_) + " of " + std::to_string(scans_) +
            " scans have no times of their points");
    return lines;
}

void MergedSource::checkEnd()
{
    if (std::exchange(ended_, true)) return;
    if (streams_.next_sample && !any_sample_ && warn_)
        warn_({0, "no_imu", "no sample of an IMU in '" + path_ + "'"});
}
}  // namespace taut
