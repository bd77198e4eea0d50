#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/ThinnedSample.h"
#include "taut/core/WarningLog.h"
#include "taut/odometry/Odometry.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/session/Doubts.h"
#include "taut/session/LiveWatch.h"

namespace taut
{
/** What metrics.json tells of a run. */
class Metrics
{
 public:
    explicit Metrics(std::string input);

    void add(const ScanResult& result);

    struct Summary
    {
        StreamProgress log;
        bool incomplete = false, interrupted = false;
        bool with_imu = true;
        double rest_seconds = 0;  //!< used by the initialisation
        double length = 0;        //!< [m]
        std::size_t map_points = 0, map_cells = 0, key_scans = 0;
        double occupancy_resolution = 0;
        std::string mode, method_file;
        int threads = 0;
        std::vector<Doubt> doubts;  //!< stretches in which the pose was in doubt
        double wall_seconds = 0;    //!< of the processing, without pictures
        bool with_slam = false;     //!< loops were looked for
        std::size_t submaps = 0, loops_judged = 0, loops_accepted = 0, loops_pending = 0,
                    loops_withdrawn = 0;
        bool path_corrected = false;
        double drift_scale = 1;          //!< Mapper::scaleOfDrift()
        double slam_seconds = 0;         //!< of wall_seconds: on loops and the graph
        double second_pass_seconds = 0;  //!< of wall_seconds
        bool second_pass = false;        //!< every point was undistorted again
        std::optional<LiveSummary> live;
        std::size_t moved_points = 0;  //!< of things that left: in map_moved.ply
        double moved_seconds = 0;      //!< spent to find them
    };
    /** JSON text. Hashes the input: reads it once. */
    std::string json(const Summary& summary, const WarningLog& warnings) const;

    int scans() const { return scans_; }
    double meanMilliseconds() const { return scans_ ? total_ms_ / scans_ : 0; }
    double duration() const { return toSeconds(last_ - first_); }

 private:
    std::string input_;
    int scans_ = 0, unmatched_ = 0, not_converged_ = 0;
    double total_ms_ = 0, max_ms_ = 0, iterations_ = 0, correspondences_ = 0;
    Time first_ = 0, last_ = 0;
    ThinnedSample<std::size_t> memory_{4096};  //!< resident memory [kB], every so many scans
};

/** Resident memory of this process [kB]: now, or the highest so far. */
std::size_t residentMemory(bool peak);
}  // namespace taut
