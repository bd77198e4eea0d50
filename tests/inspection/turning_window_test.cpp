#include <gtest/gtest.h>

#include <cmath>

#include "taut/inspection/TurningWindow.h"

namespace
{
using namespace taut;
constexpr Duration kSecond = 1'000'000'000;

ImuSample turning(double s, double rate)
{
    ImuSample sample;
    sample.t = fromSeconds(s) + 1'700'000'000 * kSecond;
    sample.gyro = rate * Vector3d(std::sin(3 * s), std::sin(4 * s), 0.3 * std::sin(5 * s));
    return sample;
}

double since(Time t)
{
    return toSeconds(t - 1'700'000'000 * kSecond);
}

TEST(TheWindow, IsWhereTheBodyTurnsMost)
{
    TurningWindow window(20);
    for (double s = 0; s < 120; s += 0.01) window.add(turning(s, s > 50 && s < 70 ? 1.0 : 0.1));
    ASSERT_TRUE(window.best());
    EXPECT_NEAR(since(window.best()->begin), 50, 1.1);
    EXPECT_NEAR(since(window.best()->end), 70, 1.1);
    EXPECT_GT(window.best()->rate, 0.8);
}

TEST(TheWindow, DoesNotReachOverAGap)
{
    TurningWindow window(20);
    for (double s = 0; s < 60; s += 0.01)
        if (s < 30 || s > 31) window.add(turning(s, s > 22 && s < 40 ? 1.0 : 0.1));
    ASSERT_TRUE(window.best());
    EXPECT_TRUE(since(window.best()->end) < 30.1 || since(window.best()->begin) > 30.9);
}

TEST(TheWindow, PrefersTurningAboutTwoAxesToTurningAboutOne)
{
    TurningWindow window(10);
    for (double s = 0; s < 40; s += 0.01)
    {
        ImuSample sample = turning(s, 0.5);
        if (s < 20) sample.gyro = {0, 0, 2 * std::sin(3 * s)};
        window.add(sample);
    }
    ASSERT_TRUE(window.best());
    EXPECT_GT(since(window.best()->end), 22);
}

TEST(TheWindow, OfAShortRecordingIsAllOfIt)
{
    TurningWindow window(20);
    EXPECT_FALSE(window.best());
    for (double s = 0; s < 5; s += 0.01) window.add(turning(s, 1));
    ASSERT_TRUE(window.best());
    EXPECT_NEAR(since(window.best()->begin), 0, 0.01);
    EXPECT_NEAR(since(window.best()->end), 5, 0.02);
}
}  // namespace
