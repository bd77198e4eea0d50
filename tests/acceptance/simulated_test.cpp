/** Recordings of taut-simulate through taut-slam: what is wrong in them is known. */
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "slam_program.h"
#include "taut/trajectory/PointTruth.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;

constexpr double kJump = 8.5;  // [s] since the start

/** The scenario with all faults, shorter and with fewer points: an IMU gap at 5 s, a LiDAR gap at
 * 6.5 s, and all clocks put forward at kJump. */
class WalkWithFaults : public testing::Test
{
 protected:
    WalkWithFaults()
    {
        const ProgramRun run = runProgram(
            TAUT_SIMULATE, "-q --points -c " TAUT_CONFIG "/scenarios/hall_walk_faults.yaml -o " +
                               log_ +
                               " --set duration=10 --set rest=3 --set lidar.dropout=0.6"
                               " --set faults.imu_gap.at=5 --set faults.lidar_gap.at=6.5"
                               " --set faults.time_jump.at=" +
                               std::to_string(kJump));
        EXPECT_EQ(run.exit_code, 0) << run.output;
    }

    const TemporaryFolder folder_;
    const std::string log_ = folder_ / "log.rawlog", truth_ = folder_ / "log.gt.tum",
                      out_ = folder_ / "out";
};

TEST_F(WalkWithFaults, IsFollowedToItsEndAndItsFaultsAreNamed)
{
    const ProgramRun run = slam(log_, out_, "-s initialization.rest_duration=3");
    EXPECT_EQ(run.exit_code, 3) << run.output;
    const auto metrics = nlohmann::json::parse(contentOf(out_ + "/metrics.json"));
    for (const char* kind : {"imu_gap", "lidar_gap", "imu_duplicate"})
        EXPECT_TRUE(metrics["warnings"].contains(kind)) << kind;
    EXPECT_EQ(metrics["warnings"]["imu_gap"], 2) << "a gap, and the clocks that jump";
    const Trajectory truth = readTum(truth_), estimate = readTum(out_ + "/trajectory.tum");
    EXPECT_LT(toSeconds(truth.back().t - estimate.back().t), 0.3);
    for (const StampedPose& pose : estimate) ASSERT_TRUE(pose.T_world_imu.p.allFinite());
    // The truth's clock jumps too: where the body is found again is where it is.
    const AbsoluteError errors = scoreTrajectory(truth, estimate).absolute;
    std::size_t poses = 0;
    double farthest = 0, most_turned = 0;
    for (const PoseError& error : errors.errors)
    {
        if (toSeconds(error.t - truth.front().t) < kJump) continue;
        poses++;
        farthest = std::max(farthest, error.position);
        most_turned = std::max(most_turned, error.rotation_deg);
    }
    EXPECT_GE(poses, 14U);
    RecordProperty("farthest_mm", std::to_string(1e3 * farthest));
    RecordProperty("most_turned_deg", std::to_string(most_turned));
    EXPECT_LT(farthest, 0.0045);    // measured: 3.0 mm
    EXPECT_LT(most_turned, 0.145);  // measured: 0.096 deg
}

TEST_F(WalkWithFaults, IsFollowedToCentimetresUntilTheClocksJump)
{
    const ProgramRun run = slam(
        log_, out_,
        "-s initialization.rest_duration=3 -s output.undistorted_points=true --to-time " +
            std::to_string(kJump - 0.2));
    EXPECT_EQ(run.exit_code, 3) << run.output;
    ScoreOptions options;
    options.min_coverage = 0.5;  // of a truth that goes on after the jump
    const Scores scores =
        scoreTrajectory(readTum(truth_), readTum(out_ + "/trajectory.tum"), options);
    EXPECT_LT(scores.absolute.position.rmse, 0.0042);  // measured: 2.8 mm
    EXPECT_LT(scores.absolute.position.max, 0.019);    // measured: 12.3 mm, in the gap of the LiDAR
    // Although some points are not finite: readers drop them, and the truth has none of them.
    const PointScores points = scorePoints(folder_ / "log.points", out_ + "/undistorted.points");
    EXPECT_LT(points.rmse, 0.014);          // measured: 9.4 mm
    EXPECT_LT(points.median_scan, 0.0024);  // measured: 1.6 mm
}

TEST(ACorridor, WithOneWallInViewIsFollowedAlongIt)
{
    // Mixed windows of wall and doors would tell of motion along the wall that there is not.
    const TemporaryFolder folder;
    const ProgramRun made = runProgram(
        TAUT_SIMULATE,
        "-q -c " TAUT_CONFIG "/scenarios/corridor_narrow_view.yaml -o " + (folder / "log.rawlog"));
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const ProgramRun run = slam(folder / "log.rawlog", folder / "out", "");
    EXPECT_THAT(run.output, testing::Not(testing::HasSubstr("[rest_left]")));
    const AbsoluteError errors =
        scoreTrajectory(readTum(folder / "log.gt.tum"), readTum(folder / "out/trajectory.tum"), {})
            .absolute;
    RecordProperty("ate_mm", std::to_string(1e3 * errors.position.rmse));
    EXPECT_LT(errors.position.rmse, 0.014);  // measured: 9.3 mm
}

/** Scores of a drive that is recorded from its midst, at 13 m/s. */
AbsoluteError ofADriveUnderWay(const std::string& settings)
{
    // The first sweep, undistorted as if the car stood, is wrong by more than a metre.
    const TemporaryFolder folder;
    const ProgramRun made = runProgram(
        TAUT_SIMULATE, "-q -c " TAUT_CONFIG "/scenarios/street_vehicle.yaml -o " +
                           (folder / "log.rawlog") +
                           " --set duration=8 --set rest=0 --set lidar.type=VLP-16" + settings);
    EXPECT_EQ(made.exit_code, 0) << made.output;
    const ProgramRun run = slam(folder / "log.rawlog", folder / "out", "");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, testing::HasSubstr("[no_rest]"));
    EXPECT_THAT(run.output, testing::Not(testing::HasSubstr("[start_unsettled]")));
    return scoreTrajectory(
               readTum(folder / "log.gt.tum"), readTum(folder / "out/trajectory.tum"), {})
        .absolute;
}

TEST(ADriveUnderWay, IsFollowedFromItsFirstSecond)
{
    const AbsoluteError errors = ofADriveUnderWay("");
    EXPECT_LT(errors.position.rmse, 0.0013);  // measured: 0.84 mm
    EXPECT_LT(errors.position.max, 0.0027);   // measured: 1.8 mm
}

TEST(ADriveUnderWay, IsNotHeldByFalseMatches)
{
    // From a car at rest, the passes end at a wrong speed with which a fifth of the points agrees.
    const AbsoluteError errors = ofADriveUnderWay(" --set seed=6");
    EXPECT_LT(errors.position.rmse, 0.0014);  // measured: 0.91 mm
    EXPECT_LT(errors.position.max, 0.0055);   // measured: 3.7 mm
}

TEST(ADriveUnderWay, AmongTreesIsFollowedFromItsFirstSecond)
{
    // Few matches, many of them false, as long as the speed is not known.
    const AbsoluteError errors = ofADriveUnderWay(" --set world.type=forest --set seed=14");
    EXPECT_LT(errors.position.rmse, 0.008);  // measured: 7.0 mm
    EXPECT_LT(errors.position.max, 0.025);   // measured: 20.2 mm
}
}  // namespace
