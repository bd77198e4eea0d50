#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Warning.h"
#include "taut/importing/ImportSource.h"

namespace taut
{
/** A recording that keeps its sensors in files of their own. */
struct SensorStreams
{
    std::function<std::optional<ImuSample>()> next_sample;  //!< empty: there is no IMU
    std::function<std::optional<Scan>()> next_scan;
    std::function<double()> progress;
    std::vector<std::string> findings;
    bool undistorted = false;  //!< somebody undistorted the scans, as is known
    std::function<std::vector<std::string>()> later_findings;  //!< complete at the end; or empty
    bool tells_pose = true;                                    //!< as ItemSource::tellsPose()
};

/** Brings the streams of two sensors into the order of time: a scan when it has ended, as a
 * recorder would. One wrong stamp does not hold its stream back: that of the next counts too. Warns
 * ("no_imu") at the end if there is an IMU without samples. */
class MergedSource : public ImportSource
{
 public:
    MergedSource(std::string path, SensorStreams streams, WarningSink warn);

    std::optional<ImportedItem> next() override;
    double progress() const override { return streams_.progress(); }
    std::vector<std::string> findings() const override;
    bool isUndistorted() const override { return streams_.undistorted; }
    bool tellsPose() const override { return streams_.tells_pose; }

 private:
    void checkEnd();
    bool sampleIsDue() const;

    std::string path_;
    SensorStreams streams_;
    WarningSink warn_;
    std::optional<ImuSample> sample_, sample_after_;
    std::optional<Scan> scan_, scan_after_;
    bool started_ = false, ended_ = false, any_sample_ = false;
    std::size_t scans_ = 0, undistorted_ = 0;
};
}  // namespace taut
