#include "TaskQueue.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <utility>

namespace taut
{
namespace
{
constexpr int kNice = 5;
}  // namespace

TaskQueue::TaskQueue(std::size_t most) : most_(most), thread_([this] { work(); }) {}

TaskQueue::~TaskQueue()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void TaskQueue::post(std::function<void()> task)
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return tasks_.size() < most_ || failed_; });
    rethrow();
    if (failed_) return;
    tasks_.push_back(std::move(task));
    changed_.notify_all();
}

void TaskQueue::drain()
{
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return tasks_.empty() || failed_; });
    rethrow();
}

void TaskQueue::rethrow()
{
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void TaskQueue::work()
{
    // Under Linux the priority is a thread's own.
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
    std::unique_lock lock(mutex_);
    for (;;)
    {
        changed_.wait(lock, [this] { return stop_ || !tasks_.empty(); });
        if (stop_) return;
        const std::function<void()> task = std::move(tasks_.front());
        lock.unlock();
        std::exception_ptr error;
        try
        {
            task();
        }
        catch (...)
        {
            error = std::current_exception();
        }
        lock.lock();
        tasks_.pop_front();
        if (error)
        {
            error_ = error;
            failed_ = true;
            tasks_.clear();
        }
        changed_.notify_all();
    }
}
}  // namespace taut
