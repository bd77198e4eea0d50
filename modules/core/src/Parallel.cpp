#include "taut/core/Parallel.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace taut
{
struct Executor::Pool
{
    using Body = std::function<void(std::size_t, std::size_t, std::size_t)>;

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

    void run(std::size_t n, std::size_t chunk, const Body& b)
    {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            size = n;
            chunk_size = chunk;
            body = &b;
            next = 0;
            error = nullptr;
            busy = threads.size();
            ++round;
        }
        wake.notify_all();
        work();
        std::unique_lock<std::mutex> lock(mutex);
        done.wait(lock, [this] { return busy == 0; });
        body = nullptr;
        if (error) std::rethrow_exception(error);
    }

    void serve()
    {
        std::size_t seen = 0;
        for (;;)
        {
            {
                std::unique_lock<std::mutex> lock(mutex);
                wake.wait(lock, [&] { return stop || round != seen; });
                if (stop) return;
                seen = round;
            }
            work();
            const std::lock_guard<std::mutex> lock(mutex);
            if (--busy == 0) done.notify_one();
        }
    }

    void work()
    {
        for (std::size_t c = next++; c * chunk_size < size; c = next++)
        {
            const std::size_t begin = c * chunk_size;
            const std::size_t end = begin + chunk_size < size ? begin + chunk_size : size;
            try
            {
                (*body)(c, begin, end);
            }
            catch (...)
            {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!error) error = std::current_exception();
            }
        }
    }

    std::vector<std::thread> threads;
    std::mutex mutex;
    std::condition_variable wake, done;
    const Body* body = nullptr;
    std::size_t size = 0, chunk_size = 1, busy = 0, round = 0;
    std::atomic<std::size_t> next{0};
    std::exception_ptr error;
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
        body(c, begin, begin + chunk_size < size ? begin + chunk_size : size);
}
}  // namespace taut
