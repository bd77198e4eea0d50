#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "taut/core/Scan.h"
#include "taut/session/LoadControl.h"

namespace taut
{
/** For a run beside the sensors. */
struct LiveConfig
{
    /** [s] since a scan was measured to its last point, called when its pose is known. Nothing
     * where that cannot be told. Empty: it never can. */
    std::function<std::optional<double>(const Scan&)> age;
    bool may_do_less = true;  //!< use a share of the scans where there is no time for all
};

/** How a run kept up with the sensors. */
struct LiveSummary
{
    double load = 0;  //!< work over the time of the recording
    /** Of the poses of all scans from when the start was caught up: age of the scan [s]. */
    double median = 0, percentile_99 = 0, worst = 0;
    std::size_t scans = 0, late = 0;  //!< of these; older than an interval between scans
    double caught_up = 0;             //!< [s] of the recording that went by before that

    /** A stretch in which only a share of each scan was used. */
    struct Reduced
    {
        Time from = 0, to = 0;
        double share = 1;
    };
    std::vector<Reduced> reduced;
};

/** Watches how late poses are and how much work they are. */
class LiveWatch
{
 public:
    explicit LiveWatch(LiveConfig config) : config_(std::move(config)) {}

    /** After each scan; `work` [s] since the one before. The share to go on with if it changed. */
    std::optional<double> add(const Scan& scan, double work);

    const LoadControl& control() const { return control_; }
    /** Of the last scan [s]. */
    std::optional<double> age() const { return last_age_; }
    LiveSummary summary() const;

 private:
    struct Told
    {
        Time t;
        float age, interval;  // [s]
    };

    LiveConfig config_;
    LoadControl control_;
    std::optional<Time> last_;
    std::optional<double> last_age_;
    std::vector<Told> poses_;
    double work_ = 0, time_ = 0;
    std::vector<LiveSummary::Reduced> reduced_;
};
}  // namespace taut
