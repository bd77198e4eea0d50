#include "taut/preintegration/Declipper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr double kLimit = 4.36;   // [rad/s], 250 deg/s
constexpr double kPeak = 8;       // [rad/s]
constexpr double kFrequency = 9;  // [rad/s] of the shaking: 1.4 Hz

double shaking(double t)
{
    return kPeak * std::sin(kFrequency * t);
}

/** Rates about y at 400 Hz, cut at the limit, with noise before the cut. */
ImuSamples cut(
    double seconds, const std::function<double(double)>& rate, double noise = 0,
    double limit = kLimit)
{
    Random random(3);
    ImuSamples samples;
    for (Time t = 0; toSeconds(t) < seconds; t += 5 * kMillisecond / 2)
    {
        ImuSample s;
        s.t = t;
        s.accel = kGravityWorld;
        s.gyro.y() = std::clamp(rate(toSeconds(t)) + noise * random.vector(1).x(), -limit, limit);
        samples.push_back(s);
    }
    return samples;
}

ImuSamples through(Declipper& declipper, const ImuSamples& samples)
{
    ImuSamples out;
    const auto append = [&](const ImuSamples& more)
    { out.insert(out.end(), more.begin(), more.end()); };
    for (const ImuSample& s : samples) append(declipper.add(s));
    append(declipper.finish());
    return out;
}

/** Angle between the samples' integral and that of the rate over the whole time [rad]. */
double worstAngle(const ImuSamples& samples, const std::function<double(double)>& rate)
{
    double angle = 0, worst = 0;
    for (std::size_t i = 1; i < samples.size(); i++)
    {
        const double a = toSeconds(samples[i - 1].t), b = toSeconds(samples[i].t);
        angle +=
            0.5 * (b - a) * (samples[i - 1].gyro.y() - rate(a) + samples[i].gyro.y() - rate(b));
        worst = std::max(worst, std::abs(angle));
    }
    return worst;
}

ImuRange knownRange()
{
    ImuRange range;
    range.gyro = kLimit;
    return range;
}
}  // namespace

TEST(Declipper, PutsBackMostOfWhatAShakenGyroHides)
{
    const ImuSamples samples = cut(1, shaking);
    Declipper declipper(knownRange());
    const ImuSamples whole = through(declipper, samples);
    ASSERT_EQ(whole.size(), samples.size());
    // Half a swing hides 0.46 rad here.
    EXPECT_GT(worstAngle(samples, shaking), 0.4);
    EXPECT_LT(worstAngle(whole, shaking), 0.06);
    EXPECT_GT(declipper.clipped(), 150u);
}

TEST(Declipper, VibrationDoesNotMisleadIt)
{
    Declipper declipper(knownRange());
    const auto vibrating = [](double t) { return shaking(t) + 0.3 * std::sin(2 * M_PI * 90 * t); };
    EXPECT_LT(worstAngle(through(declipper, cut(1, vibrating)), vibrating), 0.15);
}

TEST(Declipper, SaysHowMuchItMayMiss)
{
    Declipper declipper(knownRange());
    const ImuSamples whole = through(declipper, cut(1, shaking));
    int outside = 0, hidden = 0;
    for (const ImuSample& s : whole)
    {
        if (s.gyro_hidden == 0) continue;
        hidden++;
        if (std::abs(s.gyro.y() - shaking(toSeconds(s.t))) > 2 * s.gyro_hidden) outside++;
    }
    EXPECT_GT(hidden, 150);
    EXPECT_LT(outside, hidden / 20);
}

TEST(Declipper, SamplesWithinTheRangePassAtOnceAndUnchanged)
{
    const auto slow = [](double t) { return 0.5 * shaking(t); };
    Declipper declipper(knownRange());
    for (const ImuSample& s : cut(1, slow))
    {
        const ImuSamples out = declipper.add(s);
        ASSERT_EQ(out.size(), 1u);
        EXPECT_EQ(out[0].t, s.t);
        EXPECT_EQ(out[0].gyro, s.gyro);
        EXPECT_EQ(out[0].gyro_hidden, 0);
    }
    EXPECT_EQ(declipper.clipped(), 0u);
}

TEST(Declipper, TellsTheLimitFromReadingsThatRepeatIt)
{
    Declipper declipper;
    const ImuSamples whole = through(declipper, cut(1, shaking, 0.05));
    EXPECT_LT(worstAngle(whole, shaking), 0.1);
    EXPECT_GT(declipper.clipped(), 150u);
}

TEST(Declipper, AnExtremeThatIsPassedLaterWasNoLimit)
{
    // Six equal readings, as of a coarse sensor at the turning point of its rate.
    ImuSamples samples = cut(
        1, [](double t) { return 3 * std::sin(kFrequency * t); }, 0, 2.9);
    for (std::size_t i = samples.size() / 2; i < samples.size(); i++)
        samples[i].gyro.y() = shaking(toSeconds(samples[i].t));
    Declipper declipper;
    const ImuSamples whole = through(declipper, samples);
    for (std::size_t i = samples.size() / 2 + 80; i < samples.size(); i++)
    {
        EXPECT_EQ(whole[i].gyro, samples[i].gyro);
        EXPECT_EQ(whole[i].gyro_hidden, 0);
    }
}

TEST(Declipper, NothingStaysBehindWhereAStretchDoesNotEnd)
{
    const ImuSamples samples = cut(2, [](double) { return 9.0; });
    Declipper declipper(knownRange());
    std::size_t out = 0;
    for (const ImuSample& s : samples)
    {
        for (const ImuSample& complete : declipper.add(s))
        {
            EXPECT_EQ(complete.t, samples[out++].t);
            EXPECT_GT(complete.gyro_hidden, 1);  // its height is not known
        }
        EXPECT_LE(toSeconds(s.t - samples[out == 0 ? 0 : out - 1].t), Declipper::kLongest + 0.01);
    }
    out += declipper.finish().size();
    EXPECT_EQ(out, samples.size());
}

TEST(Declipper, AStretchOfOneAxisDoesNotWaitForOthers)
{
    // Two axes in turn at their limit, so that there is always one of them.
    ImuSamples samples = cut(2.8, shaking);
    for (ImuSample& s : samples)
        s.gyro.z() = std::clamp(kPeak * std::cos(kFrequency * toSeconds(s.t)), -kLimit, kLimit);
    Declipper declipper(knownRange());
    const ImuSamples whole = through(declipper, samples);
    ASSERT_EQ(whole.size(), samples.size());
    EXPECT_LT(worstAngle(whole, shaking), 0.2);  // after eight half swings
}

TEST(Declipper, TheAccelerometerIsTreatedAlike)
{
    ImuSamples samples = cut(1, [](double) { return 0.0; });
    const auto force = [](double t) { return 30 * std::sin(kFrequency * t); };
    for (ImuSample& s : samples) s.accel.x() = std::clamp(force(toSeconds(s.t)), -19.62, 19.62);
    std::vector<Warning> warnings;
    Declipper declipper({}, [&](const Warning& w) { warnings.push_back(w); });
    const ImuSamples whole = through(declipper, samples);
    double worst = 0;
    for (const ImuSample& s : whole)
        worst = std::max(worst, std::abs(s.accel.x() - force(toSeconds(s.t))));
    EXPECT_LT(worst, 3);  // of 10.4 that are hidden
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings[0].kind, "accel_clipped");
}
