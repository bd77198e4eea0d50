#include <gtest/gtest.h>

#include "turning.h"

namespace
{
using namespace taut;
using namespace taut::test;

TEST(AGyro, TellsTheRotationBetweenAnyTwoTimes)
{
    const Turning motion;
    const GyroRotation gyro(motion.gyro());
    for (const double s : {0.3, 4.5678, 12.3456})
    {
        const Matrix3d truth = motion.at(s).transpose() * motion.at(s + 0.777);
        const auto seen = gyro.between(kEpoch + fromSeconds(s), kEpoch + fromSeconds(s + 0.777));
        ASSERT_TRUE(seen);
        EXPECT_LT((*seen - logSO3(truth)).norm(), 2e-5);
    }
}

TEST(AGyro, TellsNothingOutsideItsSamples)
{
    const GyroRotation gyro(Turning().gyro());
    EXPECT_FALSE(gyro.between(kEpoch - 1, kEpoch + kSecond));
    EXPECT_FALSE(gyro.between(kEpoch, kEpoch + 30 * kSecond));
    EXPECT_FALSE(GyroRotation({}).between(kEpoch, kEpoch + 1));
    EXPECT_EQ(GyroRotation({}).longestGap(0, 5), 5);
}

TEST(AGyro, KnowsTheLongestGapWithinAnInterval)
{
    ImuSamples samples = Turning().gyro();
    samples.erase(samples.begin() + 201, samples.begin() + 240);  // 1.005 s to 1.195 s
    const GyroRotation gyro(samples);
    const auto at = [](double s) { return kEpoch + fromSeconds(s); };
    EXPECT_EQ(gyro.longestGap(at(0.5), at(0.9)), fromSeconds(0.005));
    EXPECT_EQ(gyro.longestGap(at(1.1), at(1.15)), fromSeconds(0.2));
    EXPECT_EQ(gyro.longestGap(at(0.5), at(1.01)), fromSeconds(0.2));
    EXPECT_EQ(gyro.longestGap(at(1.21), at(2)), fromSeconds(0.005));
}

TEST(AGyro, InAnotherUnitIsScaled)
{
    const Turning motion;
    ImuSamples in_degrees = motion.gyro();
    for (ImuSample& s : in_degrees) s.gyro *= 180 / M_PI;
    const GyroRotation rad(motion.gyro()), deg(in_degrees, M_PI / 180);
    const Time a = kEpoch + kSecond, b = kEpoch + 2 * kSecond;
    EXPECT_LT((*rad.between(a, b) - *deg.between(a, b)).norm(), 1e-9);
    EXPECT_LT((*rad.meanRate(a, b) - *rad.between(a, b)).norm(), 1e-12);
}
}  // namespace
