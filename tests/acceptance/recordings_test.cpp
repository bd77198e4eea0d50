/** The recordings that may not be copied here (TAUT_DATA); their README says what to expect. */
#include <gtest/gtest.h>

#include <algorithm>

#include "data_folder.h"
#include "slam_program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;

class Recording : public testing::Test
{
 protected:
    /** Runs one configuration for all; false (and skipped) where the recording is absent. */
    bool run(const std::string& name)
    {
        const auto log = dataFolder() / (name + ".rawlog");
        if (!std::filesystem::exists(log)) return false;
        const ProgramRun run = slam(log.string(), out_);
        EXPECT_EQ(run.exit_code, 0) << run.output;
        return true;
    }

    double errorOf(const std::string& name) const
    {
        return positionError((dataFolder() / (name + ".gt.tum")).string(), trajectory_);
    }

    const TemporaryFolder folder_;
    const std::string out_ = folder_ / "out", trajectory_ = out_ + "/trajectory.tum";
};

TEST_F(Recording, OfAViolentMotionIsFollowedToMillimetres)
{
    if (!run("hall_violent")) return skipWithout("hall_violent.rawlog");
    EXPECT_LT(errorOf("hall_violent"), 0.0011);  // measured: 0.74 mm
}

TEST_F(Recording, OfARealHandheldImuIsFollowedToMillimetres)
{
    if (!run("handheld_real_imu")) return skipWithout("handheld_real_imu.rawlog");
    EXPECT_LT(errorOf("handheld_real_imu"), 0.0019);  // measured: 1.26 mm
}

TEST_F(Recording, OfACarWithoutImuMovesOneMetreAScan)
{
    if (!run("street_hdl64")) return skipWithout("street_hdl64.rawlog");
    const Trajectory car = readTum(trajectory_);
    ASSERT_GE(car.size(), 20U);
    for (std::size_t i = 1; i < car.size(); i++)
    {
        const double way = (car[i].T_world_imu.p - car[i - 1].T_world_imu.p).norm();
        EXPECT_GT(way, 0.97) << "scan " << i;  // measured: 0.985 to 1.050 m
        EXPECT_LT(way, 1.08) << "scan " << i;
    }
}

TEST_F(Recording, OfARealDriveHasTheRingsThatThePaperNeeds)
{
    const auto drive = dataFolder() / "kitti/2011_09_26/2011_09_26_drive_0009_sync";
    if (!std::filesystem::exists(drive)) return skipWithout("kitti");
    const std::string log = folder_ / "drive.rawlog";
    const ProgramRun import = runProgram(TAUT_IMPORT, drive.string() + " -o " + log);
    ASSERT_EQ(import.exit_code, 0) << import.output;
    EXPECT_NE(import.output.find("rings: 64, told from the order"), std::string::npos);
    const ProgramRun run = slam(log, out_, "-c " TAUT_CONFIG "/paper.yaml");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const std::string truth = (dataFolder() / "kitti/drive_0009.gt.tum").string();
    EXPECT_LT(positionError(truth, trajectory_), 0.16);  // measured: 0.12 m of 55 m
}

TEST_F(Recording, OfATripodTurnsInPlace)
{
    if (!run("tripod_vlp16_imu")) return skipWithout("tripod_vlp16_imu.rawlog");
    const Trajectory tripod = readTum(trajectory_);
    ASSERT_GE(tripod.size(), 90U);
    double farthest = 0;
    for (const StampedPose& pose : tripod)
        farthest = std::max(farthest, (pose.T_world_imu.p - tripod[0].T_world_imu.p).norm());
    EXPECT_LT(farthest, 0.2);  // measured: 0.14 m
}
}  // namespace
