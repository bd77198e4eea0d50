#include <gtest/gtest.h>

#include "taut/packets/TurnAssembler.h"

namespace taut::test
{
namespace
{
constexpr Duration kStep = 55'555;  // ns: 0.2 deg at 10 Hz
constexpr Time kBegin = 1'700'000'000'000'000'000;

/** Blocks of 0.2 deg with one return each, whose intensity is the azimuth in whole degrees. */
class ATurn : public testing::Test
{
 protected:
    /** From one azimuth on [0.01 deg] by so many blocks, and a pause before. */
    void turn(int from, int blocks, int direction = 1, Duration pause = 0)
    {
        t_ += pause;
        for (int i = 0; i < blocks; i++, t_ += kStep)
        {
            const int azimuth = ((from + direction * 20 * i) % 36000 + 36000) % 36000;
            turns_.beginBlock(azimuth, t_, complete_);
            turns_.add({1, 0, 0}, static_cast<float>(azimuth / 100), 0, t_);
        }
    }

    std::vector<std::size_t> sizes()
    {
        std::vector<std::size_t> sizes;
        for (const Scan& scan : complete_) sizes.push_back(scan.points.size());
        return sizes;
    }

    using Sizes = std::vector<std::size_t>;
    TurnAssembler turns_{16};
    std::vector<Scan> complete_;
    Time t_ = kBegin;
};

TEST_F(ATurn, EndsWhereTheAzimuthPassesZero)
{
    turn(30010, 300 + 1800 + 1800 + 10);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({300, 1800, 1800, 10}));
    EXPECT_EQ(complete_[0].stamp, kBegin);
    EXPECT_EQ(complete_[1].stamp, kBegin + 300 * kStep);
    EXPECT_EQ(complete_[1].end, kBegin + 2099 * kStep);
    EXPECT_EQ(complete_[1].points[0].offset, 0);
    EXPECT_EQ(complete_[1].points[0].intensity, 0);
    EXPECT_EQ(complete_[1].rings, 16);
}

TEST_F(ATurn, FromZeroIsNoTurnTooMany)
{
    turn(0, 1800 + 1800 + 1);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({1800, 1800, 1}));
}

TEST_F(ATurn, TheOtherWayRoundEndsThereToo)
{
    turn(5990, 300 + 1800 + 10, -1);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({300, 1800, 10}));
}

TEST_F(ATurn, ThatIsCutShortEndsAtZeroAsWell)
{
    turn(30010, 300 + 500);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({300, 500}));
}

TEST_F(ATurn, OfASectorIsWholeAcrossZero)
{
    for (int i = 0; i < 3; i++) turn(27010, 900, 1, i > 0 ? 900 * kStep : 0);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({900, 900, 900}));
    EXPECT_EQ(complete_[1].stamp, kBegin + 1800 * kStep);
}

TEST_F(ATurn, WithALostPartGoesOnEndingAtZero)
{
    turn(10, 500);
    turn(14010, 1100, 1, 200 * kStep);
    turn(10, 1800 + 1800);
    turns_.finish(complete_);
    // What was lost looks like a sector left out, until a whole turn comes without it.
    EXPECT_EQ(sizes(), Sizes({500, 1800, 1100, 1800}));
}

TEST_F(ATurn, ThatLostAPartLaterIsNotCutThere)
{
    turn(10, 1800 + 500);
    turn(14010, 1100 + 1800, 1, 200 * kStep);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({1800, 1600, 1800}));
}

TEST_F(ATurn, ThatNeverEndsIsCutByItsTime)
{
    for (int i = 0; i < 10'000; i++, t_ += kStep)
    {
        turns_.beginBlock(100, t_, complete_);
        turns_.add({1, 0, 0}, 0, 0, t_);
    }
    ASSERT_EQ(complete_.size(), 2U);
    EXPECT_NEAR(static_cast<double>(complete_[0].end - complete_[0].stamp), 250e6, 1e5);
}

TEST_F(ATurn, WhoseClockLeapsIsCutThere)
{
    turn(10, 100);
    turn(2010, 100, 1, 3'600'000'000'000);
    turn(4010, 100, 1, -7'200'000'000'000);
    turns_.finish(complete_);
    EXPECT_EQ(sizes(), Sizes({100, 100, 100}));
}
}  // namespace
}  // namespace taut::test
