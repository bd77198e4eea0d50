#include <gtest/gtest.h>

#include "taut/inspection/IntervalStatistics.h"

namespace
{
using namespace taut;
constexpr Duration kMillisecond = 1'000'000;

TEST(IntervalStatistics, TellTheUsualIntervalAndWhatIsShorterOrLonger)
{
    IntervalStatistics s;
    EXPECT_EQ(s.median(), 0);
    for (int i = 0; i < 100; i++) s.add(i * kMillisecond, 5 * kMillisecond);
    for (int i = 0; i < 9; i++) s.add(i * kMillisecond, 50 * kMillisecond);
    for (int i = 0; i < 7; i++) s.add(i * kMillisecond, kMillisecond);
    EXPECT_NEAR(s.median(), 0.005, 1e-9);
    EXPECT_EQ(s.count(), 116U);
    EXPECT_EQ(s.longer(0.02), 9U);
    EXPECT_EQ(s.shorter(0.002), 7U);
    EXPECT_EQ(s.longer(10), 0U);
}

TEST(IntervalStatistics, KeepTheLargestWithTheirTimes)
{
    IntervalStatistics s;
    for (Time i = 1; i <= 100; i++) s.add(i, (i * 37 % 101) * kMillisecond);
    ASSERT_FALSE(s.largest().empty());
    for (std::size_t i = 0; i < s.largest().size(); i++)
    {
        const Duration length = (100 - static_cast<Duration>(i)) * kMillisecond;
        EXPECT_EQ(s.largest()[i].length, length);
        EXPECT_EQ((s.largest()[i].begin * 37 % 101) * kMillisecond, length);
    }
}

TEST(IntervalStatistics, TakeAnyLength)
{
    IntervalStatistics s;
    s.add(1, 0);
    s.add(2, -5 * kMillisecond);
    s.add(3, Duration{1} << 62);
    EXPECT_EQ(s.shorter(1e-3), 2U);
    EXPECT_EQ(s.longer(1e6), 1U);
    EXPECT_EQ(s.largest().front().begin, 3);
}
}  // namespace
