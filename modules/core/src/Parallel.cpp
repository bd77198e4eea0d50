#include "taut/core/Parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace taut
{
namespace
{
using Body = std::function<void(std::size_t, std::size_t, std::size_t)>;

/** One call of forChunks(). A thread that wakes late finds it done and touches nothing: nobody
 * waits for threads, only for chunks. */
struct Job
{
    Job(std::size_t job_size, std::size_t chunk, const Body& job_body)
        : size(job_size),
          chunk_size(chunk),
          unfinished(Executor::chunks(size, chunk)),
          body(job_body)
    {
    }

    /** True if this thread finished the last chunk. */
    bool work()
    {
        std::size_t finished = 0;
        for (std::size_t c = next++; c * chunk_size < size; c = next++)
        {
            const std::size_t begin = c * chunk_size;
            try
            {
                body(c, begin, std::min(begin + chunk_size, size));
            }
            catch (...)
            {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!error) error = std::current_exception();
            }
            finished++;
        }
        return finished > 0 && unfinished.fetch_sub(finished) == finished;
    }

    const std::size_t size, chunk_size;
    std::atomic<std::size_t> next{0}, unfinished;
    const Body& body;  // alive as long as there are unfinished chunks
    std::mutex mutex;
    std::exception_ptr error;
};
}  // namespace

struct Executor::Pool
{
    explicit Pool(int workers)
    {
        for (int i = 0; i < workers; i++) threads.emplace_back([this] { serve(); });
    }
    ~Pool()
    {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            stop = true;
        }
        wake.notify_all();
        for (auto& t : threads) t.join();
    }

    void run(std::size_t size, std::size_t chunk_size, const Body& body)
    {
        const auto mine = std::make_shared<Job>(size, chunk_size, body);
        {
            const std::lock_guard<std::mutex> lock(mutex);
            job = mine;
        }
        wake.notify_all();
        if (!mine->work())
        {
            std::unique_lock<std::mutex> lock(mutex);
            done.wait(lock, [&] { return mine->unfinished == 0; });
        }
        if (mine->error) std::rethrow_exception(mine->error);
    }

    void serve()
    {
        std::shared_ptr<Job> last;
        for (;;)
        {
            {
                std::unique_lock<std::mutex> lock(mutex);
                wake.wait(lock, [&] { return stop || job != last; });
                if (stop) return;
                last = job;
            }
            if (!last->work()) continue;
            const std::lock_guard<std::mutex> lock(mutex);
            done.notify_one();
        }
    }

    std::vector<std::thread> threads;
    std::mutex mutex;
    std::condition_variable wake, done;
    std::shared_ptr<Job> job;  //!< the last one
    bool stop = false;
};

Executor::Executor(int threads) : threads_(threads < 1 ? 1 : threads)
{
    if (threads_ > 1) pool_ = std::make_unique<Pool>(threads_ - 1);
}

Executor::~Executor() = default;

void Executor::forChunks(
    std::size_t size, std::size_t chunk_size,
    const std::function<void(std::size_t, std::size_t, std::size_t)>& body)
{
    if (size == 0) return;
    if (pool_ && size > chunk_size)
    {
        pool_->run(size, chunk_size, body);
        return;
    }
    for (std::size_t c = 0, begin = 0; begin < size; c++, begin += chunk_size)
        body(c, begin, std::min(begin + chunk_size, size));
}
}  // namespace taut
