#pragma once

#include <memory>
#include <optional>

#include "taut/odometry/Events.h"

namespace taut
{
class Synchronizer;

/** From two streams to a trajectory: synchronises them, finds a start, and hands each scan with the
 * samples that reach over it to the odometry. What comes of it is told as events.
 *
 * Samples and scans may come in any interleaving, each stream in the order of time. Not
 * thread-safe; the sinks are called from within add() and finish(). */
class Pipeline
{
 public:
    Pipeline(OdometryConfig config, Executor& executor, WarningSink warn, EventSink events);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    void add(const ImuSample& sample);
    void add(Scan scan);

    /** No more data: processes what was held back. Does nothing the second time. Throws what
     * processing throws, after the last events were told. */
    void finish();

    /** False as soon as it is clear that the estimation runs without an IMU from its start on. */
    bool withImu() const;
    const std::optional<Initialization>& initialization() const { return initialization_; }
    /** Scans that wait for the IMU or for a start. */
    std::size_t waiting() const;
    /** See Odometry::setShare(). May be called from within the events. */
    void setShare(double share) { odometry_.setShare(share); }
    /** Cells or points in the local map. */
    std::size_t mapSize() const { return odometry_.mapSize(); }

 private:
    void advance();
    void tellEnd();
    void findStart();
    void start();
    const ImuSamples* samplesFor(const Scan& scan) const;
    std::vector<ScanResult> firstScansFrom(const Initialization& start);
    void process(const Scan& scan);
    void refineLast(const ScanResult& next);
    void judge(const ScanResult& result);
    bool isOpenForLong(const ScanResult& result);
    void warn(Time t, const std::string& kind, const std::string& text) const;

    OdometryConfig config_;
    WarningSink warn_;
    EventSink events_;
    std::unique_ptr<Synchronizer> streams_;
    Initializer initializer_;
    Odometry odometry_;
    std::optional<Initialization> initialization_;
    std::optional<Sweep> last_sweep_;  // whose end is not final yet
    std::optional<NavState>
        last_shown_;    // by the last scan that showed the position in all directions
    std::string lost_;  // cause; empty: the pose is not in doubt
    std::size_t estimated_ = 0;
    bool needs_imu_, finished_ = false;
};
}  // namespace taut
