#include "taut/session/Doubts.h"

#include <gtest/gtest.h>

using namespace taut;

namespace
{
constexpr Time kSecond = 1'000'000'000;

Event scanAt(Time t)
{
    static const Scan scan;
    static ScanResult result;
    result.estimate.state.t = t;
    return Estimated{scan, result};
}
}  // namespace

TEST(Doubts, KeepWhenTheyBeganAndEnded)
{
    Doubts doubts;
    doubts.add(scanAt(1 * kSecond));
    doubts.add(Lost{2 * kSecond, "pose_doubtful"});
    doubts.add(scanAt(2 * kSecond));
    doubts.add(scanAt(3 * kSecond));
    doubts.add(Recovered{4 * kSecond, "pose_doubtful"});
    doubts.add(scanAt(9 * kSecond));
    ASSERT_EQ(doubts.all().size(), 1u);
    EXPECT_EQ(doubts.all()[0].from, 2 * kSecond);
    EXPECT_EQ(doubts.all()[0].to, 4 * kSecond);
    EXPECT_TRUE(doubts.all()[0].recovered);
    EXPECT_TRUE(doubts.serious());
}

TEST(Doubts, OneThatDoesNotEndGrowsWithTheScans)
{
    Doubts doubts;
    doubts.add(Lost{2 * kSecond, "imu_silent"});
    doubts.add(scanAt(7 * kSecond));
    EXPECT_EQ(doubts.all()[0].to, 7 * kSecond);
    EXPECT_FALSE(doubts.all()[0].recovered);
    EXPECT_TRUE(doubts.serious());
}

TEST(Doubts, AMomentWithoutMatchesIsNotSerious)
{
    Doubts doubts;
    doubts.add(Lost{2 * kSecond, "few_correspondences"});
    doubts.add(Recovered{3 * kSecond, "few_correspondences"});
    EXPECT_FALSE(doubts.serious());
    doubts.add(Lost{5 * kSecond, "few_correspondences"});
    doubts.add(scanAt(6 * kSecond + 1));
    EXPECT_TRUE(doubts.serious());
}
