#include <gmock/gmock.h>

#include <filesystem>

#include "slam_program.h"
#include "taut/rawlog/Rig.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;

ProgramRun merge(const std::string& arguments)
{
    return runProgram(TAUT_PROGRAMS "/taut-merge", arguments);
}

TEST(TwoRuns, OfOnePlaceBecomeOneMapThatIsUsedAgain)
{
    const TemporaryFolder folder;
    ASSERT_EQ(slam(kSample, folder / "a").exit_code, 0);
    ASSERT_EQ(slam(kSample, folder / "b", "--from-time 2").exit_code, 0);
    const std::string inputs = folder / "a" + " " + (folder / "b");
    const ProgramRun run = merge(inputs + " --no-pictures -o " + (folder / "ab"));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("2 runs joined"));
    for (const char* name :
         {"graph.g2o", "loops.csv", "map.ply", "map.ot", "map.bt", "map.simplemap", "submaps"})
        EXPECT_TRUE(std::filesystem::exists(folder / "ab" + "/" + name)) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "ab/merge.part"));
    // Two submaps measure a few millimetres worse than the odometry.
    for (const char* name : {"/trajectory_1.tum", "/trajectory_2.tum"})
        EXPECT_LT(positionError(kSampleTruth, folder / "ab" + name), 0.01) << name;

    EXPECT_EQ(merge(inputs + " -o " + (folder / "ab")).exit_code, 2);  // results are there
    const ProgramRun again = slam(kSample, folder / "c", "-m " + (folder / "ab"));
    EXPECT_EQ(again.exit_code, 0) << again.output;
}

TEST(TwoRuns, ThatCannotBeJoinedAreToldWithTheCause)
{
    const TemporaryFolder folder;
    ASSERT_EQ(slam(kSample, folder / "a").exit_code, 0);
    const std::string a = folder / "a", out = " -o " + (folder / "out");
    EXPECT_EQ(merge(a + out).exit_code, 2);
    EXPECT_EQ(merge(a + " " + a + out).exit_code, 2);
    EXPECT_EQ(merge(a + " " + (folder / "b") + " -o " + a).exit_code, 2);
    const ProgramRun none = merge(a + " " + (folder / "b") + out);
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_THAT(none.output, HasSubstr("graph.g2o is missing"));
}

TEST(ACalibration, LeavesARigFileThatARunTakes)
{
    const TemporaryFolder folder;
    const std::string rig = folder / "rig.yaml", program = TAUT_PROGRAMS "/taut-calibrate";
    std::ofstream(folder / "base.yaml") << "lidar: {label: 'LIDAR|it''s', clock_offset: 0}\n"
                                           "imu: {noise: {gyro: 0.001}}\n";
    const std::string arguments =
        kSample + " --passes 1 -r " + (folder / "base.yaml") + " -o " + rig;
    const ProgramRun run = runProgram(program, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const Rig found = loadRig(rig);
    EXPECT_EQ(found.lidar.label, "LIDAR|it's");
    ASSERT_TRUE(found.imu.noise);
    EXPECT_EQ(found.imu.noise->gyro, 0.001);
    ASSERT_EQ(found.lidar.beams.elevation.size(), 16u);
    // The beams of the sample do not err.
    for (std::size_t ring = 0; ring < 16; ring++)
    {
        EXPECT_LT(std::abs(found.lidar.beams.elevation[ring]), 0.002) << ring;
        EXPECT_LT(std::abs(found.lidar.beams.range[ring]), 0.01) << ring;
    }
    EXPECT_EQ(runProgram(program, arguments).exit_code, 2);  // is there already
}
}  // namespace
