#include "taut/simulation/Replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulation_support.h"
#include "taut/simulation/Random.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;
using ::testing::HasSubstr;

namespace
{
/** A recording of a motion at 100 Hz with noise of 0.5 mm. */
std::vector<RecordedPose> record(const Motion& motion, double duration, double noise = 5e-4)
{
    Random random(1);
    std::vector<RecordedPose> recording;
    for (double t = 0; t <= duration; t += 0.01)
    {
        Pose pose = motion.poseAt(t);
        pose.p += noise * random.normalVector();
        recording.push_back({1'000'000'000'000 + fromSeconds(t), pose});
    }
    return recording;
}

std::string messageOf(const std::vector<RecordedPose>& recording, double duration)
{
    try
    {
        makeReplay(recording, {}, 0.02, duration, 0);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(Replay, FollowsTheRecordingSmoothly)
{
    const Motion original = motionOf(MotionPreset::Calm, 12, 1);
    ReplayConfig config;
    config.smoothing = 0.08;
    config.T_world_origin = {expSO3(Vector3d(0, 0, 0.5)), Vector3d(3, 4, 0.5)};
    const Motion replay = makeReplay(record(original, 11), config, 0.02, 10, 0);
    for (double t = 0.5; t < 9.5; t += 0.05)
    {
        const Pose expected = config.T_world_origin * original.poseAt(t);
        const MotionState s = replay.at(t);
        EXPECT_LT((s.T_world_imu.p - expected.p).norm(), 0.01);
        EXPECT_LT(logSO3(expected.R.transpose() * s.T_world_imu.R).norm(), 0.02);
        EXPECT_LT(s.a_world.norm(), 5);  // 0.5 mm of noise at 100 Hz would be 10 m/s^2
    }
}

TEST(Replay, HoldsTheFirstPoseDuringTheRest)
{
    const Motion original = motionOf(MotionPreset::Fast, 12, 0);
    const Motion replay = makeReplay(record(original, 11), {}, 0.02, 12, 4);
    for (double t = 0; t <= 4; t += 0.1)
    {
        EXPECT_LT(replay.at(t).v_world.norm(), 1e-9);
        EXPECT_LT(replay.at(t).rate.norm(), 1e-9);
    }
    EXPECT_GT(replay.at(8).v_world.norm(), 0.2);
}

TEST(Replay, SaysWhatIsWrongWithARecording)
{
    const Motion original = motionOf(MotionPreset::Calm, 6, 1);
    auto recording = record(original, 5);
    EXPECT_THAT(messageOf(recording, 8), HasSubstr("needs 8"));
    auto gap = recording;
    gap.erase(gap.begin() + 100, gap.begin() + 200);
    EXPECT_THAT(messageOf(gap, 4), HasSubstr("gap at 2"));
    auto backward = recording;
    std::swap(backward[50], backward[60]);
    EXPECT_THAT(messageOf(backward, 4), HasSubstr("back in time"));
    EXPECT_THAT(messageOf({}, 4), HasSubstr("no two poses"));
}
