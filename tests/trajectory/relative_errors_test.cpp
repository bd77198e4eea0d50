#include "taut/trajectory/RelativeErrors.h"

#include <gtest/gtest.h>

#include "motions.h"
#include "numeric.h"

using namespace taut;

namespace
{
/** Poses along a path of constant curvature [rad/m], `spacing` metres and 0.1 s apart. */
Trajectory arc(int n, double spacing, double curvature)
{
    Trajectory out;
    for (int i = 0; i < n; i++)
    {
        const double s = i * spacing, a = curvature * s;
        const Vector3d p =
            curvature == 0 ? Vector3d(s, 0, 0)
                           : Vector3d(std::sin(a) / curvature, (1 - std::cos(a)) / curvature, 0);
        out.push_back({test::kStart + i * 100'000'000LL, {expSO3({0, 0, a}), p}});
    }
    return out;
}

/** How far the end of an arc of length s is from the end of the straight line of the same length.
 */
double arcError(double s, double curvature)
{
    return (arc(2, s, curvature)[1].T_world_imu.p - Vector3d(s, 0, 0)).norm();
}

PosePairs pairsOf(const Trajectory& truth, const Trajectory& estimate)
{
    return pairPoses(truth, estimate);
}
}  // namespace

TEST(RelativeErrors, OfAScaleErrorIsTheScaleTimesTheDistance)
{
    // 2 m/s: 0.2 m every 0.1 s, measured 1 % too long.
    const auto pairs = pairsOf(arc(301, 0.2, 0), arc(301, 0.202, 0));
    const RelativeError second = relativeErrorOverTime(pairs, 1);
    EXPECT_EQ(second.translation.count, 291u);
    EXPECT_NEAR(second.translation.rmse, 0.02, 1e-9);
    EXPECT_NEAR(second.translation.max, 0.02, 1e-9);
    EXPECT_NEAR(second.rotation_deg.max, 0, 1e-9);
    const RelativeError metres = relativeErrorOverDistance(pairs, 10);
    EXPECT_EQ(metres.translation.count, 251u);
    EXPECT_NEAR(metres.translation.rmse, 0.1, 1e-9);
}

TEST(RelativeErrors, OfAYawDriftIsTheDriftAndTheArcItBends)
{
    const double drift = 0.01;  // rad/m
    const auto pairs = pairsOf(arc(301, 0.2, 0), arc(301, 0.2, drift));
    const RelativeError e = relativeErrorOverTime(pairs, 5);  // 10 m
    EXPECT_NEAR(e.rotation_deg.rmse, drift * 10 * kDegreesPerRadian, 1e-9);
    EXPECT_NEAR(e.rotation_deg.max, drift * 10 * kDegreesPerRadian, 1e-9);
    EXPECT_NEAR(e.translation.mean, arcError(10, drift), 1e-9);
}

TEST(RelativeErrors, DoNotDependOnTheWorldFrames)
{
    const Trajectory truth = test::lissajous(30, 10);
    Trajectory estimate = truth;
    taut::test::Random random(3);
    for (auto& pose : estimate) pose.T_world_imu.p += random.vector(0.01);
    const Pose T{expSO3({1, 2, -1}), {10, 20, 30}};
    const auto here = relativeErrorOverTime(pairsOf(truth, estimate), 1);
    const auto there = relativeErrorOverTime(pairsOf(truth, test::moved(T, estimate)), 1);
    EXPECT_NEAR(here.translation.rmse, there.translation.rmse, 1e-12);
    // Two independent noises of 1 cm by axis.
    EXPECT_NEAR(here.translation.rmse, 0.01 * std::sqrt(6.0), 0.002);
}

TEST(RelativeErrors, TakeNoPairThatIsFarFromTheDistanceAskedFor)
{
    const auto pairs = pairsOf(arc(20, 0.4, 0), arc(20, 0.4, 0));
    EXPECT_EQ(relativeErrorOverTime(pairs, 0.14).translation.count, 0u);  // 0.1 is 29 % off
    EXPECT_EQ(relativeErrorOverTime(pairs, 0.106).translation.count, 18u);
    EXPECT_EQ(relativeErrorOverTime(pairs, 5).translation.count, 0u);
    EXPECT_EQ(relativeErrorOverDistance(pairs, 100).translation.count, 0u);
    EXPECT_EQ(relativeErrorOverDistance({}, 1).translation.count, 0u);
}

TEST(RelativeErrors, ReachOverAGapOfTheEstimate)
{
    const Trajectory truth = arc(301, 0.2, 0);
    Trajectory estimate = arc(301, 0.202, 0);
    estimate.erase(estimate.begin() + 100, estimate.begin() + 200);
    const auto e = relativeErrorOverTime(pairsOf(truth, estimate), 10.1);
    // From pose 99 to 200 exactly; within the tolerance from 89..98 to 200 and from 0..8 to 99.
    EXPECT_EQ(e.translation.count, 1u + 10u + 9u);
    EXPECT_NEAR(e.translation.max, 0.002 * 111, 1e-9);  // from pose 89: 22.2 m instead of 20.2 m
}

TEST(SegmentErrors, OfAYawDriftAreKnown)
{
    const double drift = 0.0002, spacing = 0.37;
    const auto pairs = pairsOf(arc(3000, spacing, 0), arc(3000, spacing, drift));
    const SegmentErrors errors = kittiSegmentErrors(pairs);
    ASSERT_EQ(errors.by_length.size(), 8u);
    double sum = 0;
    std::size_t count = 0;
    for (const SegmentError& e : errors.by_length)
    {
        // The first pose that is further than the length, as the development kit has it.
        const double steps = std::floor(e.length / spacing) + 1, reach = steps * spacing;
        EXPECT_NEAR(e.rotation_deg_per_m, drift * reach / e.length * kDegreesPerRadian, 1e-9);
        EXPECT_NEAR(e.translation_percent, 100 * arcError(reach, drift) / e.length, 1e-7);
        EXPECT_EQ(e.count, std::ceil((3000 - steps) / 10));
        sum += e.translation_percent * static_cast<double>(e.count);
        count += e.count;
    }
    EXPECT_EQ(errors.all.count, count);
    EXPECT_NEAR(errors.all.translation_percent, sum / static_cast<double>(count), 1e-9);
}

TEST(SegmentErrors, OfAScaleErrorAreItsPercentage)
{
    const auto pairs = pairsOf(arc(500, 0.1, 0), arc(500, 0.102, 0));
    EXPECT_EQ(kittiSegmentErrors(pairs).all.count, 0u);  // 50 m are too short
    const SegmentErrors errors = shortSegmentErrors(pairs);
    EXPECT_GT(errors.all.count, 1000u);
    EXPECT_NEAR(errors.by_length.back().translation_percent, 2, 0.01);
    EXPECT_NEAR(errors.all.rotation_deg_per_m, 0, 1e-9);
}
