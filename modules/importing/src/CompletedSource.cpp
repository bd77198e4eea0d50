#include "CompletedSource.h"

#include <cstdlib>
#include <stdexcept>

#include "taut/core/format.h"

namespace taut
{
CompletedSource::CompletedSource(
    const Opener& open, const ImportOptions& options, const WarningSink& warn)
    : source_(open(warn)), completer_(options.scan_times, source_->isUndistorted())
{
    const auto ahead = open({});
    try
    {
        while (auto item = ahead->next())
        {
            if (std::holds_alternative<PacketScan>(*item)) break;  // those have all
            auto* scan = std::get_if<Scan>(&*item);
            if (scan == nullptr)
            {
                completer_.learn(std::get<ImuSample>(*item));
                continue;
            }
            if (first_stamp_ == 0) first_stamp_ = scan->stamp;
            if (!completer_.learn(std::move(*scan))) break;
        }
    }
    catch (const std::runtime_error&)
    {
        // What was read until then is what there is; the source itself will say the cause.
    }
    completer_.finishLearning();
    judged_ = completer_.findings();
    if (completer_.interval() > 0)
        judgeStamp(options.scan_stamp, ahead->arrivalDelay(), warn);
    else if (options.scan_times == ScanTimes::Azimuth && !judged_.empty() && warn)
        warn({first_stamp_, "scan_times", judged_.back()});
}

/** By the IMU; else by the recorder: a sweep cannot arrive before it was measured. Soon after its
 * stamp, that is its end. */
void CompletedSource::judgeStamp(
    ScanStamp asked, std::optional<Duration> arrival_delay, const WarningSink& warn)
{
    constexpr int kFarthest = 5;  // sweeps: later, clocks differ
    const Duration interval = completer_.interval();
    if (arrival_delay && std::abs(*arrival_delay) > kFarthest * interval) arrival_delay.reset();
    const auto by_imu = completer_.stampIsEnd();
    const bool is_end = asked != ScanStamp::Detect ? asked == ScanStamp::End
                        : by_imu                   ? *by_imu
                                                   : arrival_delay && *arrival_delay < interval / 2;
    completer_.setStampIsEnd(is_end);
    const std::string text =
        "stamp of a sweep: taken as its " + std::string(is_end ? "end" : "start");
    if (asked != ScanStamp::Detect)
        judged_.push_back(text + ", as asked for");
    else if (by_imu)
        judged_.push_back(text + ", for then the gyro turned as the view did");
    else if (arrival_delay)
        judged_.push_back(
            text + ", for it was recorded " +
            format("%.3g ms", 1e-6 * static_cast<double>(*arrival_delay)) + " after that");
    else if (warn)
        warn(
            {first_stamp_, "scan_stamp",
             text + "; nothing in the recording tells which end it is: --scan-stamp start or end "
                    "says"});
}

std::optional<ImportedItem> CompletedSource::next()
{
    auto item = source_->next();
    if (auto* scan = item ? std::get_if<Scan>(&*item) : nullptr) completer_.complete(*scan);
    return item;
}

std::vector<std::string> CompletedSource::findings() const
{
    auto lines = source_->findings();
    lines.insert(lines.end(), judged_.begin(), judged_.end());
    return lines;
}
}  // namespace taut
