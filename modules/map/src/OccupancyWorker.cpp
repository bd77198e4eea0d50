#include "taut/map/OccupancyWorker.h"

#include <stdexcept>
#include <utility>

namespace taut
{
OccupancyWorker::OccupancyWorker(const OccupancyMap::Config& config, std::size_t capacity)
    : capacity_(capacity < 1 ? 1 : capacity), map_(config), thread_([this] { work(); })
{
}

OccupancyWorker::~OccupancyWorker()
{
    stop(/*drop_queue=*/true);
}

void OccupancyWorker::submit(Time t, const Vector3d& origin, std::vector<Vector3d> points)
{
    std::unique_lock<std::mutex> lock(mutex_);
    if (stopping_) throw std::logic_error("OccupancyWorker: submit() after finish()");
    changed_.wait(lock, [this] { return queue_.size() < capacity_ || failed_; });
    if (failed_) return;
    queue_.push_back({t, origin, std::move(points)});
    changed_.notify_all();
}

OccupancyMap& OccupancyWorker::finish(const WarningSink& warn)
{
    stop(/*drop_queue=*/false);
    const std::vector<Warning> warnings = std::exchange(warnings_, {});
    if (warn)
        for (const Warning& warning : warnings) warn(warning);
    if (error_) std::rethrow_exception(error_);
    return map_;
}

void OccupancyWorker::stop(bool drop_queue)
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
        if (drop_queue) queue_.clear();
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void OccupancyWorker::work()
{
    const WarningSink keep = [this](const Warning& w) { warnings_.push_back(w); };
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;)
    {
        changed_.wait(lock, [this] { return !queue_.empty() || stopping_; });
        if (queue_.empty()) return;
        const Job job = std::move(queue_.front());
        queue_.pop_front();
        lock.unlock();
        changed_.notify_all();
        std::exception_ptr error;
        try
        {
            map_.insert(job.t, job.origin, job.points, keep);
        }
        catch (...)
        {
            error = std::current_exception();
        }
        lock.lock();
        if (!error) continue;
        error_ = error;
        failed_ = true;
        queue_.clear();
        changed_.notify_all();
        return;
    }
}
}  // namespace taut
