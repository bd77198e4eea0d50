#include <gtest/gtest.h>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;

TEST(Motion, DerivativesEqualNumericOnes)
{
    constexpr double h = 1e-4;
    for (const MotionPreset preset : kMovingPresets)
    {
        const Motion motion = motionOf(preset, 12);
        for (double t = 0.0317; t < 12; t += 0.0931)
        {
            const MotionState before = motion.at(t - h), s = motion.at(t), after = motion.at(t + h);
            const Vector3d v = (after.T_world_imu.p - before.T_world_imu.p) / (2 * h);
            const Vector3d a = (after.v_world - before.v_world) / (2 * h);
            const Matrix3d& R = s.T_world_imu.R;
            const Vector3d rate = (logSO3(R.transpose() * after.T_world_imu.R) -
                                   logSO3(R.transpose() * before.T_world_imu.R)) /
                                  (2 * h);
            const Vector3d alpha = (after.rate - before.rate) / (2 * h);
            EXPECT_LT((s.v_world - v).norm(), 1e-5) << t;
            EXPECT_LT((s.a_world - a).norm(), 1e-3) << t;
            EXPECT_LT((s.rate - rate).norm(), 1e-4) << t;
            EXPECT_LT((s.angular_acceleration - alpha).norm(), 1e-2) << t;
        }
    }
}

TEST(Motion, AccelerationHasNoJumpsAtKnots)
{
    const MotionConfig config = motionPreset(MotionPreset::Violent);
    const Motion motion = motionOf(MotionPreset::Violent, 8);
    constexpr double epsilon = 1e-9;
    for (double knot = config.knot_spacing; knot < 8; knot += config.knot_spacing)
    {
        const MotionState before = motion.at(knot - epsilon), after = motion.at(knot + epsilon);
        EXPECT_LT((before.a_world - after.a_world).norm(), 1e-5) << knot;
        EXPECT_LT((before.angular_acceleration - after.angular_acceleration).norm(), 1e-4) << knot;
    }
}

TEST(Motion, RestsUntilToldAndMovesAfterwards)
{
    for (const MotionPreset preset : kMovingPresets)
    {
        const Motion motion = motionOf(preset, 12, 5);
        const Pose start = motion.poseAt(0);
        for (double t = 0; t <= 5; t += 0.25)
        {
            const MotionState s = motion.at(t);
            EXPECT_LT((s.T_world_imu.p - start.p).norm(), 1e-12);
            EXPECT_LT(s.rate.norm(), 1e-9) << t;
            EXPECT_LT(s.a_world.norm(), 1e-9) << t;
        }
        EXPECT_GT((motion.poseAt(12).p - start.p).norm(), 0.5);
    }
}

TEST(Motion, WithoutARestItMovesFromTheFirstMomentOn)
{
    for (const MotionPreset preset : kMovingPresets)
    {
        const MotionState s = motionOf(preset, 5, 0).at(0);
        EXPECT_GT(s.v_world.norm(), 0.2);
        EXPECT_GT(s.rate.norm(), 0.05);
    }
}

TEST(Motion, PresetsReachTheirPeaksAndNotMore)
{
    const auto peaks = [](MotionPreset preset) { return peaksOf(motionOf(preset, 30)); };
    EXPECT_NEAR(peaks(MotionPreset::Calm).rate, 1, 0.05);
    EXPECT_NEAR(peaks(MotionPreset::Fast).rate, 3, 0.25);
    EXPECT_NEAR(peaks(MotionPreset::Violent).rate, 8, 0.3);
    EXPECT_NEAR(peaks(MotionPreset::Violent).angular_acceleration, 75, 4);
    EXPECT_LT(peaks(MotionPreset::Walk).speed, 1.6);
}

TEST(Motion, TheSeedDecides)
{
    const auto at = [](std::uint64_t seed)
    { return motionOf(MotionPreset::Violent, 6, 1, seed).poseAt(5.1234).p; };
    EXPECT_EQ(at(3), at(3));
    EXPECT_GT((at(3) - at(4)).norm(), 1e-3);
}
