#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "taut/map/OccupancyMap.h"

namespace taut
{
/** Feeds an OccupancyMap in a thread of its own, in the order of submission: the map is the same as
 * without the worker. */
class OccupancyWorker
{
 public:
    /** At most `capacity` scans wait. */
    explicit OccupancyWorker(const OccupancyMap::Config& config, std::size_t capacity = 8);

    /** Leaves what still waits undone. */
    ~OccupancyWorker();
    OccupancyWorker(const OccupancyWorker&) = delete;
    OccupancyWorker& operator=(const OccupancyWorker&) = delete;

    /** Hands over a scan as OccupancyMap::insert() takes it; waits while the queue is full. Nothing
     * more is taken after a failure. Throws std::logic_error after finish(). */
    void submit(Time t, const Vector3d& origin, std::vector<Vector3d> points);

    /** Waits until all is done, passes on the warnings and rethrows the exception that ended the
     * work, if any; then gives the map. May be called again. */
    OccupancyMap& finish(const WarningSink& warn);

 private:
    struct Job
    {
        Time t;
        Vector3d origin;
        std::vector<Vector3d> points;
    };

    void work();
    void stop(bool drop_queue);

    const std::size_t capacity_;
    OccupancyMap map_;  // of the thread, until it has ended
    std::vector<Warning> warnings_;
    std::exception_ptr error_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> queue_;
    bool stopping_ = false, failed_ = false;
    std::thread thread_;
};
}  // namespace taut
