#include "taut/core/NavState.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;

TEST(NavState, LocalInvertsRetract)
{
    taut::test::Random random(1);
    for (int i = 0; i < 50; i++)
    {
        NavState origin;
        origin.T_world_imu = {expSO3(random.vector(1)), random.vector(10)};
        origin.v_world = random.vector(3);
        NavState::Vector delta;
        for (int k = 0; k < NavState::kSize; k++) delta[k] = 0.5 * random.normal();
        EXPECT_LT((origin.retract(delta).localFrom(origin) - delta).norm(), 1e-10);
    }
}
