#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace taut
{
/** Work that is done in the order in which it is given, in a thread beside the caller's, with what
 * time the others leave. After the first exception nothing more is done. */
class TaskQueue
{
 public:
    /** At most `most` tasks wait. */
    explicit TaskQueue(std::size_t most);
    /** What waits is not done any more. */
    ~TaskQueue();
    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    /** Waits while too many tasks do. Rethrows, once, what a task has thrown. */
    void post(std::function<void()> task);

    /** Waits until all is done. Rethrows as post() does. */
    void drain();

 private:
    void work();
    void rethrow();

    std::size_t most_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;  // the first one is being done
    std::exception_ptr error_;
    bool failed_ = false, stop_ = false;
    std::thread thread_;
};
}  // namespace taut
