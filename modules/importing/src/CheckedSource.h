#pragma once

#include <deque>
#include <map>
#include <memory>

#include "taut/core/ImuUnits.h"
#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"
#include "taut/importing/ImportSource.h"
#include "taut/rawlog/StampOrder.h"

namespace taut
{
/** Stands before every source: judges the units of the IMU by its first 2 s and converts to m/s^2
 * and rad/s, and lets nothing pass that goes back in time or is not finite. Throws at the end if
 * there was no scan. Warnings:
 *   imu_units     values that fit no unit, or another one than the first seconds said
 *   clock_offset  both sensors were recorded at different times, by their stamps
 *   stamp_outlier, imu_order, clock_back   see StampOrder
 *   imu_time      stamp of the IMU equal to or earlier than the one before (left out)
 *   imu_invalid   values that are not finite (left out)
 *   scan_time     stamp of a scan equal to or earlier than the one before (left out) */
class CheckedSource : public ImportSource
{
 public:
    /** `path` is for messages. */
    CheckedSource(
        std::string path, std::unique_ptr<ImportSource> source, const ImportOptions& options,
        WarningSink warn);

    std::optional<ImportedItem> next() override;
    double progress() const override { return source_->progress(); }
    std::vector<std::string> findings() const override;
    bool tellsPose() const override { return source_->tellsPose(); }

 private:
    std::optional<ImportedItem> nextInOrder();
    std::optional<ImportedItem> nextValid();
    bool valid(const ImuSample& sample);
    bool valid(const Scan& scan) { return isLater(scan.stamp, last_scan_, "scan_time", "scan"); }
    bool valid(const PacketScan& scan)
    {
        return isLater(scan.stamp, last_scan_, "scan_time", "scan");
    }
    bool isLater(
        Time t, std::optional<Time>& last, const std::string& kind, const std::string& what);
    void judge();
    void convert(ImuSample& sample);
    void finish();
    void compareSpans() const;
    void warn(Time t, const std::string& kind, const std::string& text) const;

    std::string path_;
    std::unique_ptr<ImportSource> source_;
    ImportOptions options_;
    WarningSink warn_;
    StampOrder order_;
    std::map<std::size_t, ImportedItem> ahead_;  // by its id there
    bool all_read_ = false;
    std::deque<ImportedItem> held_;  // until the units are known
    bool judged_ = false, finished_ = false, too_fast_ = false;
    ImuUnitJudge judge_;
    std::size_t samples_ = 0, scans_ = 0, held_scans_ = 0;
    Time first_sample_ = 0;
    ImuUnits units_;
    std::optional<Time> last_sample_, last_scan_;
    Time first_scan_ = 0;
};
}  // namespace taut
