#include "taut/core/Parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace taut;

namespace
{
double sumByChunks(int threads)
{
    Executor executor(threads);
    const std::size_t n = 10007, chunk = 64;
    std::vector<double> partial(Executor::chunks(n, chunk), 0.0);
    for (int repeat = 0; repeat < 20; repeat++)
        executor.forChunks(
            n, chunk,
            [&](std::size_t c, std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; i++)
                    partial[c] += std::sin(static_cast<double>(i));
            });
    double sum = 0;
    for (const double p : partial) sum += p;
    return sum;
}
}  // namespace

TEST(Executor, SumsAreBitEqualForAnyNumberOfThreads)
{
    const double one = sumByChunks(1);
    EXPECT_EQ(one, sumByChunks(2));
    EXPECT_EQ(one, sumByChunks(5));
}

TEST(Executor, VisitsEveryIndexOnce)
{
    Executor executor(3);
    std::vector<int> visits(1000, 0);
    executor.forChunks(
        visits.size(), 7,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++) visits[i]++;
        });
    for (const int v : visits) EXPECT_EQ(v, 1);
}

TEST(Executor, RethrowsAnErrorOfABodyAndGoesOn)
{
    Executor executor(2);
    EXPECT_THROW(
        executor.forChunks(
            100, 10,
            [](std::size_t c, std::size_t, std::size_t)
            {
                if (c == 5) throw std::runtime_error("chunk 5");
            }),
        std::runtime_error);
    int calls = 0;
    executor.forChunks(5, 10, [&](std::size_t, std::size_t, std::size_t) { calls++; });
    EXPECT_EQ(calls, 1);
}
