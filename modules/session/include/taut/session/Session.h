#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>

#include "taut/core/WarningLog.h"
#include "taut/odometry/Pipeline.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/session/Doubts.h"
#include "taut/session/LiveWatch.h"
#include "taut/session/Method.h"
#include "taut/session/Metrics.h"
#include "taut/session/ResultFiles.h"
#include "taut/session/SecondPass.h"
#include "taut/slam/Mapper.h"
#include "taut/trajectory/Trajectory.h"

namespace taut
{
class DiskReserve;
class TaskQueue;

struct SessionConfig
{
    Method method;
    std::string folder;       //!< of the results; has to be there
    std::string input;        //!< file of the measurements: named and hashed in metrics.json
    std::string method_file;  //!< named in metrics.json
    std::string rig;          //!< text of the rig file; empty: there is none
    std::optional<KnownMap> known_map;  //!< that the run is joined to; loops have to be on
    int threads = 1;
    bool pictures = true;
    bool report = true;  //!< write report.html, of the other results
    Trajectory truth;    //!< that it is to compare the run with; empty: none
    /** The measurements come as they are made. The poses are then told before anything else is done
     * with them: submaps and loops are worked on in a thread beside. The results are the same. */
    std::optional<LiveConfig> live;
};

/** How a session ended. What was computed is on the disk in any case, as far as it takes it. */
struct SessionOutcome
{
    int poses = 0;
    double length = 0;                                 //!< [m] of the trajectory
    double duration = 0;                               //!< [s] of the recording
    double wall_seconds = 0, milliseconds_a_scan = 0;  //!< of the estimation
    std::size_t map_points = 0;
    std::size_t submaps = 0, loops = 0;  //!< loops: that are believed
    bool corrected = false;              //!< the path is not the odometry's any more
    bool undistorted_again = false;      //!< every point, along the path that the loops corrected
    bool pictures_failed = false, report_failed = false;
    std::optional<LiveSummary> live;  //!< of a live run
    bool interrupted = false;
    /** A part of the input was not used, or a stretch of the pose is in doubt: metrics.json tells
     * which. */
    bool partly = false;
    std::string failure;  //!< what ended the estimation or the saving first; empty: nothing did
};

/** One run from measurements to a folder of results: trajectory, states, map, occupancy octree,
 * submaps, loops, pictures and metrics. Whatever ends it, what was computed up to there is written.
 *
 * Where loops are closed, the path is not the odometry's any more. The recording is then streamed
 * again, if it can be, and every point undistorted along the corrected path; else the points of the
 * submaps are moved.
 *
 * With a stream there is run(). A program with sensors of its own calls add() for each measurement
 * and finish() at the end. Not thread-safe; several sessions can run at once in one program. */
class Session
{
 public:
    /** `warnings` gets all warnings and is asked for metrics.json; it must outlive this. `events`
     * (may be empty) gets what the Pipeline tells, after it was written. Throws std::runtime_error
     * if a file cannot be written. */
    Session(const SessionConfig& config, WarningLog& warnings, EventSink events = {});
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /** Throws what the estimation or the writing throws; finish() can still be called. */
    void add(Measurement measurement);

    /** Completes all files, the trajectory first; one that fails (SessionOutcome::failure, else the
     * warning not_saved) keeps none of the others. `log` and `incomplete` tell what was read. */
    SessionOutcome finish(const StreamProgress& log, bool incomplete, bool interrupted = false);

    /** Opens the stream of a run once more, from its begin. */
    using Reopen = std::function<std::unique_ptr<MeasurementStream>()>;

    /** Reads a stream to its end, or until `go_on` returns false. Calls it after each measurement
     * with the share of the stream that is read (0 to 1), in the second pass again from 0. An
     * interrupted second pass falls back to the points of the submaps. Exceptions end the
     * estimation, not the session: they are told in the outcome. */
    SessionOutcome run(
        MeasurementStream& log, const std::function<bool(double)>& go_on, Reopen reopen = {});

    bool inSecondPass() const { return second_pass_; }

    int scans() const { return metrics_.scans(); }
    double duration() const { return metrics_.duration(); }  //!< [s] estimated so far
    /** Of a live run: how late the last pose was [s]. */
    std::optional<double> age() const { return watch_ ? watch_->age() : std::nullopt; }

 private:
    void take(const Event& event);
    void write(const Event& event);
    void takeRefined(const Refined& refined);
    void watchLoad(const Estimated& estimated);
    void tellMapper(std::function<void()> step);
    void passWarningsOn();
    void closeLoops();
    bool streamAgain(const std::vector<SweepRecord>& records, MapExport& map);
    void takeCorrectedPath();
    void takeOutMovedThings();
    void rewriteAlong(const std::vector<StampedPose>& path);
    bool processAll(MeasurementStream& log, const std::function<bool(double)>& go_on);
    void attempt(const std::function<void()>& step);
    bool drawPictures() const;
    bool writePage() const;
    std::vector<std::string> caption() const;
    void writeMetrics(const StreamProgress& log, bool incomplete, bool interrupted);
    bool usedPartly(const StreamProgress& log, bool incomplete) const;

    SessionConfig config_;
    WarningLog& warnings_;
    EventSink events_;
    Executor executor_;
    std::unique_ptr<DiskReserve> reserve_;  // for metrics.json
    std::unique_ptr<MapExport> map_;
    std::unique_ptr<PathFiles> path_;
    ResultFiles files_;
    Metrics metrics_;
    Doubts doubts_;
    std::unique_ptr<Executor> mapper_executor_;  // of a live run
    std::unique_ptr<Mapper> mapper_;             // null: loops are not asked for
    std::mutex mapper_warnings_mutex_;
    std::vector<Warning> mapper_warnings_;  // of the thread beside
    std::unique_ptr<TaskQueue> beside_;     // of a live run: the only one to use the mapper
    std::vector<SweepRecord> records_;
    NavState::Matrix covariance_ = NavState::Matrix::Zero();  // of the last estimate
    Reopen reopen_;
    std::function<bool(double)> go_on_;
    bool second_pass_ = false, undistorted_again_ = false, interrupted_again_ = false;
    double second_pass_seconds_ = 0, moved_seconds_ = 0;
    std::size_t moved_points_ = 0;
    std::optional<LiveWatch> watch_;
    double idle_seconds_ = 0, last_idle_ = 0;  // waited for measurements
    std::chrono::steady_clock::time_point last_estimated_;
    Pipeline pipeline_;
    double wall_seconds_ = 0;
    std::string failure_;  // the first; empty: there was none
    bool written_ = true;  // what the last event told
};
}  // namespace taut
