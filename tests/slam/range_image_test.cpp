#include "taut/core/RangeImage.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

TEST(ARangeImage, TellsTheNearestReturnAround)
{
    RangeImage image;
    const Vector3d d = Vector3d(1, 2, 0.3).normalized();
    image.add(7.0 * d);
    image.add(5.0 * d);
    image.add(9.0 * d);
    ASSERT_TRUE(image.nearestAround(d));
    EXPECT_NEAR(*image.nearestAround(d), 5, 0.011);
    image.add(3.0 * (expSO3({0, 0, 0.02}) * d));  // in a cell beside it
    EXPECT_NEAR(*image.nearestAround(d), 3, 0.011);
}

TEST(ARangeImage, SaysNothingWhereThereWasNoReturn)
{
    RangeImage image;
    image.add({4, 0, 0});
    EXPECT_FALSE(image.nearestAround({-1, 0, 0}));
    EXPECT_FALSE(image.nearestAround(expSO3({0, 0, 0.03}) * Vector3d(1, 0, 0)));
    image.add({0, 0, 0});
    image.add({0, 1e4, 0});  // further than can be kept
    EXPECT_FALSE(image.nearestAround({0, 1, 0}));
}

TEST(ARangeImage, CoversTheWholeSphere)
{
    Random random(3);
    RangeImage image;
    for (int i = 0; i < 10'000; i++)
    {
        const Vector3d p = random.vector(3);
        image.add(p);
        ASSERT_TRUE(image.nearestAround(p));
        ASSERT_LE(*image.nearestAround(p), p.norm());
    }
    for (const Vector3d& pole : {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(-1, 1e-12, 0)})
    {
        image.add(2 * pole);
        EXPECT_LE(*image.nearestAround(pole), 2);
    }
}
