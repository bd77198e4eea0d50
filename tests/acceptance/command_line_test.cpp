#include <gmock/gmock.h>

#include <filesystem>

#include "slam_program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;
using testing::HasSubstr;

TEST(TheCommandLine, ExplainsEveryOption)
{
    const ProgramRun run = slam("--help");
    EXPECT_EQ(run.exit_code, 0);
    for (const char* option :
         {"-i",
          "--input",
          "-o",
          "--output",
          "-c",
          "--config",
          "-s",
          "--set",
          "-r",
          "--rig",
          "--lidar",
          "--imu",
          "--from-time",
          "--to-time",
          "--only-first-n",
          "-p",
          "--plugin",
          "--threads",
          "-w",
          "--overwrite",
          "--no-pictures",
          "--show-config",
          "-q",
          "--quiet",
          "-v",
          "--verbosity",
          "--version",
          "Exit codes"})
        EXPECT_THAT(run.output, HasSubstr(option));
}

TEST(TheCommandLine, GivesTwoForBadUsage)
{
    EXPECT_EQ(slam("").exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample).exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample + " -o x --no-such-option").exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample + " -o x -v LOUD").exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample + " -o x --from-time 5 --to-time 4").exit_code, 2);
}

TEST(TheCommandLine, OverwritesOnlyWhenTold)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    ASSERT_EQ(slam(kSample, out, "--only-first-n 40").exit_code, 0);
    const std::string before = contentOf(out + "/trajectory.tum");
    const ProgramRun refused = slam(kSample, out, "--only-first-n 41");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.output, HasSubstr("-w"));
    EXPECT_EQ(contentOf(out + "/trajectory.tum"), before);
    EXPECT_EQ(slam(kSample, out, "--only-first-n 41 -w").exit_code, 0);
    EXPECT_NE(contentOf(out + "/trajectory.tum"), before);
}

TEST(TheCommandLine, SaysNothingWhenQuiet)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(kSample, folder / "out", "-q --only-first-n 300");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.output, "");
}

TEST(TheCommandLine, GivesOneAndTheNameOfAMissingFile)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(folder / "absent.rawlog", folder / "out");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.output, HasSubstr("absent.rawlog"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(TheCommandLine, NamesAnUnknownKey)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(kSample, folder / "out", "-s features.voxel_sise=0.2");
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("features.voxel_sise"));
    EXPECT_THAT(run.output, HasSubstr("voxel_size"));
}

TEST(TheCommandLine, SetsKeysAtAnyDepthAndOtherClasses)
{
    const ProgramRun run = slam(
        "-i a -o b --show-config -s output.occupancy.resolution=0.5 -s features.sectors=9 "
        "-s features.type=taut::CurvatureExtractor");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("    resolution: 0.5 "));
    EXPECT_THAT(run.output, HasSubstr("  sectors: 9 "));
    for (const char* wrong : {"features=3", "features.voxel_size", "estimation.balance.x=1"})
        EXPECT_EQ(slam(std::string("-i a -o b --show-config -s ") + wrong).exit_code, 2) << wrong;
}

TEST(TheCommandLine, ShowsTheConfigurationAndDoesNothingElse)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(
        kSample, folder / "out",
        "--show-config -c " TAUT_CONFIG "/paper.yaml -s lidar.max_range=7");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("type: 'taut::KdTreeMap'"));
    EXPECT_THAT(run.output, HasSubstr("max_range: 7 "));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}
}  // namespace
