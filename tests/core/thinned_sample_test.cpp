#include "taut/core/ThinnedSample.h"

#include <gtest/gtest.h>

using taut::ThinnedSample;

TEST(ThinnedSample, KeepsAllWhileThereIsRoom)
{
    ThinnedSample<int> sample(10);
    for (int i = 0; i < 9; i++) sample.add(i);
    EXPECT_EQ(sample.items().size(), 9u);
    EXPECT_EQ(sample.items().back(), 8);
}

TEST(ThinnedSample, StaysEvenAndBounded)
{
    ThinnedSample<int> sample(10);
    for (int i = 0; i < 1000; i++)
    {
        sample.add(i);
        ASSERT_LT(sample.items().size(), 10u);
    }
    ASSERT_GE(sample.items().size(), 5u);
    EXPECT_EQ(sample.items()[0], 0);
    const int step = sample.items()[1];
    for (std::size_t k = 1; k < sample.items().size(); k++)
        EXPECT_EQ(sample.items()[k] - sample.items()[k - 1], step);
}
