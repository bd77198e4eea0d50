#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace taut
{
/** A small pool of threads for loops over arrays. Work is cut in chunks whose bounds depend on the
 * size alone, never on the number of threads: sums that are kept by chunk and added in the order of
 * the chunks are therefore bit-equal with any number of threads. */
class Executor
{
 public:
    explicit Executor(int threads = 1);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    int threads() const { return threads_; }

    static std::size_t chunks(std::size_t size, std::size_t chunk_size)
    {
        return (size + chunk_size - 1) / chunk_size;
    }

    /** Calls body(chunk, begin, end) once for every chunk of [0, size) and waits for all. The first
     * exception of a body is rethrown here. */
    void forChunks(
        std::size_t size, std::size_t chunk_size,
        const std::function<void(std::size_t chunk, std::size_t begin, std::size_t end)>& body);

 private:
    struct Pool;
    int threads_;
    std::unique_ptr<Pool> pool_;
};
}  // namespace taut
