#pragma once

#include <functional>
#include <memory>

#include "taut/completion/SweepCompleter.h"
#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"
#include "taut/importing/ImportSource.h"

namespace taut
{
/** Stands after every source: gives sweeps the times and rings that the recording left out, as
 * SweepCompleter finds them. What it has to know it learns by reading the beginning of the
 * recording a first time. Warnings:
 *   scan_stamp   the times of the points are told from their azimuth, but nothing tells whether
 *                stamps are begin or end of the sweeps (the begin is assumed)
 *   scan_times   times from the azimuth were asked for, but cannot be told */
class CompletedSource : public ImportSource
{
 public:
    using Opener = std::function<std::unique_ptr<ImportSource>(const WarningSink& warn)>;

    /** `open` opens the recording; it is called twice. What goes wrong while learning is not
     * reported: it will be when the sweeps come again. */
    CompletedSource(const Opener& open, const ImportOptions& options, const WarningSink& warn);

    std::optional<ImportedItem> next() override;
    double progress() const override { return source_->progress(); }
    std::vector<std::string> findings() const override;
    bool tellsPose() const override { return source_->tellsPose(); }

 private:
    void judgeStamp(
        ScanStamp asked, std::optional<Duration> arrival_delay, const WarningSink& warn);

    std::unique_ptr<ImportSource> source_;
    SweepCompleter completer_;
    Time first_stamp_ = 0;
    std::vector<std::string> judged_;
};
}  // namespace taut
