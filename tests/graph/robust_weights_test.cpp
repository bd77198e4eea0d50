#include <gtest/gtest.h>

#include "taut/graph/RobustConfig.h"

using namespace taut;

TEST(TruncatedWeight, IsOneBelowTheBandAndZeroAboveIt)
{
    for (double mu : {1e-6, 0.1, 1.0, 50.0})
    {
        const double low = 16.8 * mu / (mu + 1), high = 16.8 * (mu + 1) / mu;
        EXPECT_EQ(truncatedWeight(0, 16.8, mu), 1);
        EXPECT_EQ(truncatedWeight(0.999 * low, 16.8, mu), 1);
        EXPECT_EQ(truncatedWeight(1.001 * high, 16.8, mu), 0);
        // No jump at either end.
        EXPECT_NEAR(truncatedWeight(low * (1 + 1e-9), 16.8, mu), 1, 1e-6);
        EXPECT_NEAR(truncatedWeight(high * (1 - 1e-9), 16.8, mu), 0, 1e-6);
    }
}

/** Black-Rangarajan: the weight minimises w r^2 + penalty(w) with
 * penalty = mu (1 - w) c^2 / (mu + w) (Yang et al., 2020, equation 14). */
TEST(TruncatedWeight, MinimisesTheCostWithItsPenalty)
{
    const double c2 = 16.8;
    for (double mu : {0.05, 1.0, 20.0})
        for (double chi2 : {1.0, 10.0, 16.0, 18.0, 60.0, 200.0})
        {
            const auto cost = [&](double w) { return w * chi2 + mu * (1 - w) * c2 / (mu + w); };
            const double w = truncatedWeight(chi2, c2, mu);
            for (double other = 0; other <= 1; other += 0.01)
                EXPECT_LE(cost(w), cost(other) + 1e-9) << mu << ' ' << chi2 << ' ' << other;
        }
}
