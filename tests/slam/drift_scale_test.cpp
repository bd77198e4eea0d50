#include "taut/slam/DriftScale.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** Gaps of an odometry whose variances are `truth` times what it says. */
std::vector<ClosedGap> gapsOf(double truth, int count, double loop_sigma, Random& random)
{
    std::vector<ClosedGap> gaps;
    for (int i = 0; i < count; i++)
    {
        ClosedGap g;
        g.of_odometry = square(0.05) * Matrix6d::Identity();
        g.information = Matrix6d::Identity() / square(loop_sigma);
        for (int k = 0; k < 6; k++)
            g.gap[k] = 0.05 * std::sqrt(truth) * random.normal() + loop_sigma * random.normal();
        gaps.push_back(g);
    }
    return gaps;
}
}  // namespace

TEST(TheDriftScale, IsFoundFromTheGaps)
{
    Random random(1);
    for (const double truth : {0.04, 1.0, 25.0})
    {
        double sum = 0;
        for (int i = 0; i < 50; i++)
            sum += std::log(driftScale(gapsOf(truth, 12, 0.003, random)) / truth);
        EXPECT_NEAR(sum / 50, 0, 0.2) << truth;
    }
}

TEST(TheDriftScale, StaysAtItsGuessWhereLoopsTellNothing)
{
    Random random(2);
    EXPECT_EQ(driftScale({}), 1);
    // The loops are far less certain than the odometry.
    EXPECT_NEAR(std::log(driftScale(gapsOf(1, 3, 50.0, random))), 0, 0.3);
}

TEST(TheDriftScale, DoesNotLookAlongWhatALoopDoesNotShow)
{
    Random random(3);
    std::vector<ClosedGap> gaps = gapsOf(1, 12, 0.003, random);
    const double before = driftScale(gaps);
    for (ClosedGap& g : gaps)
    {
        g.information.row(2).setZero();
        g.information.col(2).setZero();
        g.gap[2] = 1e3;
    }
    EXPECT_NEAR(std::log(driftScale(gaps) / before), 0, 0.4);
}
