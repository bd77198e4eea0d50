#include "taut/slam/ClosureGate.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

TEST(ChiSquare, HasTheTabulatedQuantiles)
{
    EXPECT_NEAR(chiSquareBeyond(0.01, 6), 16.81, 0.1);
    EXPECT_NEAR(chiSquareBeyond(0.0027, 6), 20.06, 0.15);
    EXPECT_NEAR(chiSquareBeyond(0.0027, 3), 14.16, 0.15);
    EXPECT_NEAR(chiSquareBeyond(0.05, 1), 3.84, 0.1);
}

TEST(AGap, OfTheCovarianceItHasIsAsLikelyAsItShould)
{
    Random random(5);
    Matrix6d root;
    for (int i = 0; i < 36; i++) root(i / 6, i % 6) = 0.1 * random.normal();
    const Matrix6d of_graph = root * root.transpose() + 1e-4 * Matrix6d::Identity();
    const Matrix6d of_loop = 1e-3 * Matrix6d::Identity();
    const Eigen::LLT<Matrix6d> both(of_graph + of_loop);
    int within = 0;
    double sum = 0;
    constexpr int kTrials = 20'000;
    for (int i = 0; i < kTrials; i++)
    {
        Vector6d z;
        for (int k = 0; k < 6; k++) z[k] = random.normal();
        const GapTest test = testGap(both.matrixL() * z, of_graph, of_loop.inverse());
        ASSERT_EQ(test.directions, 6);
        within += test.isWithin(0.05);
        sum += test.chi2;
    }
    EXPECT_NEAR(within / static_cast<double>(kTrials), 0.95, 0.006);
    EXPECT_NEAR(sum / kTrials, 6, 0.08);
}

TEST(AGap, AlongADirectionThatTheLoopDoesNotShowSaysNothing)
{
    Matrix6d information = 1e4 * Matrix6d::Identity();
    information(0, 0) = 0;
    Vector6d gap = Vector6d::Zero();
    gap[0] = 100;
    const GapTest along = testGap(gap, 1e-4 * Matrix6d::Identity(), information);
    EXPECT_EQ(along.directions, 5);
    EXPECT_LT(along.chi2, 1e-9);
    gap[1] = 1;
    EXPECT_FALSE(testGap(gap, 1e-4 * Matrix6d::Identity(), information).isWithin(1e-6));
    EXPECT_FALSE(testGap(gap, Matrix6d::Identity(), Matrix6d::Zero()).isWithin(0.5));
}
