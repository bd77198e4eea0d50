#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <vector>

#include "slam_program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;
using testing::HasSubstr;
using testing::MatchesRegex;

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
    EXPECT_EQ(slam("-i " + kSample + " -o x --no-such-option").exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample + " -o x -v LOUD").exit_code, 2);
    EXPECT_EQ(slam("-i " + kSample + " -o x --from-time 5 --to-time 4").exit_code, 2);
}

/** Every program, and what it says is missing where nothing is given. */
struct Program
{
    const char *name, *missing;
};

void PrintTo(const Program& program, std::ostream* out)
{
    *out << program.name;
}

class EveryProgram : public testing::TestWithParam<Program>
{
 protected:
    ProgramRun run(const std::string& arguments) const
    {
        return runProgram(std::string(TAUT_PROGRAMS "/") + GetParam().name, arguments);
    }

    const std::string name_ = GetParam().name, see_ = "; see " + name_ + " --help\n";
};

TEST_P(EveryProgram, SaysInOneLineWhatIsMissing)
{
    const ProgramRun run = this->run("");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.output, name_ + ": " + GetParam().missing + see_);
}

TEST_P(EveryProgram, NamesTheOptionThatWasMeant)
{
    for (const char* wrong : {"--hepl", "--hlp", "-help"})
    {
        const ProgramRun run = this->run(std::string("a ") + wrong + " b");
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_EQ(
            run.output, name_ + ": unknown option '" + wrong + "'; did you mean '--help'?" + see_);
    }
    const ProgramRun far = run("--no-such-option-anywhere");
    EXPECT_EQ(far.exit_code, 2);
    EXPECT_EQ(far.output, name_ + ": unknown option '--no-such-option-anywhere'" + see_);
}

TEST_P(EveryProgram, BeginsItsOptionsWithThoseRequiredAndGivesExamples)
{
    const ProgramRun run = this->run("--help");
    EXPECT_EQ(run.exit_code, 0);
    const auto examples = run.output.find("Examples:\n  " + name_ + " ");
    const auto required = run.output.find("\nRequired:\n  ");
    const auto options = run.output.find("\nOptions:\n  ");
    ASSERT_NE(options, std::string::npos) << run.output;
    EXPECT_LT(examples, required);
    EXPECT_LT(required, options);
    EXPECT_GT(run.output.find("--version"), options);
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 90U) << line;
}

TEST_P(EveryProgram, TellsItsVersionInOneLine)
{
    EXPECT_THAT(
        run("--version").output,
        MatchesRegex(name_ + " " TAUT_VERSION " [(]commit ([0-9a-f]{7,40}(-dirty)?|unknown)[)]\n"));
}

TEST_P(EveryProgram, FailsWhereItsOutputCannotBeWritten)
{
    if (!std::ofstream("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const ProgramRun run =
        runProgram("sh -c '" TAUT_PROGRAMS "/" + name_ + " --help >/dev/full'", "");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.output, name_ + ": cannot write to the standard output\n");
}

TEST_P(EveryProgram, OutlivesAReaderWhoWentAway)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    close(ends[0]);
    const std::string program = TAUT_PROGRAMS "/" + name_;
    const pid_t child = fork();
    if (child == 0)
    {
        std::signal(SIGPIPE, SIG_DFL);
        dup2(ends[1], STDOUT_FILENO);
        execl(program.c_str(), program.c_str(), "--help", nullptr);
        _exit(127);
    }
    close(ends[1]);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 1);
}

const std::vector<Program> kPrograms{
    {"taut-slam", "argument RECORDING is required"},
    {"taut-live", "option -o/--output is required"},
    {"taut-import", "argument SOURCE and option -o/--output are required"},
    {"taut-info", "argument RECORDING is required"},
    {"taut-merge", "argument RUN/ and option -o/--output are required"},
    {"taut-calibrate", "argument RECORDING and option -o/--output are required"},
    {"taut-evaluate", "option --truth and option --estimate are required"},
#ifdef TAUT_WITH_SIMULATE
    {"taut-simulate", "option -c/--config and option -o/--output are required"},
#endif
    {"taut-report", "argument OUT/ is required"},
    {"taut-render", "option -i/--input is required"}};

INSTANTIATE_TEST_SUITE_P(
    Named, EveryProgram, testing::ValuesIn(kPrograms),
    [](const auto& test) { return std::string(test.param.name).substr(5); });

TEST(TheCommandLine, SaysPlainlyWhatIsWrong)
{
    const auto says = [](const std::string& arguments)
    {
        const ProgramRun run = slam(arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments;
        return run.output;
    };
    EXPECT_EQ(says("-o x"), "taut-slam: argument RECORDING is required; see taut-slam --help\n");
    EXPECT_THAT(says("-i a --ouput b"), HasSubstr("did you mean '--output'?"));
    EXPECT_THAT(says("-i a --output=b"), HasSubstr("did you mean '--output b'?"));
    EXPECT_THAT(says("-i a -o b -x"), HasSubstr("unknown option '-x';"));
    EXPECT_THAT(says("-i a -o b -qwx"), HasSubstr("unknown option '-qwx';"));
    EXPECT_THAT(says("-i a -o b c"), HasSubstr("unexpected argument 'c'"));
    EXPECT_THAT(says("-i a -o"), HasSubstr("option -o/--output: "));
    EXPECT_THAT(says("-i a -o b --threads two"), HasSubstr("option --threads: "));
    EXPECT_THAT(says("-i a -o b --threads -1"), HasSubstr("--threads must be 0 to 256"));
}

TEST(TheCommandLine, TakesSwitchesOfOneLetterInOneWord)
{
    const TemporaryFolder folder;
    EXPECT_EQ(slam(kSample, folder / "out", "-qw --only-first-n 40").output, "");
}

// Else what is printed would stand in the first files that are opened.
TEST(TheCommandLine, KeepsResultsCleanWhereTheStandardStreamsAreClosed)
{
    const TemporaryFolder folder;
    const std::string usual = folder / "usual", closed = folder / "closed";
    const std::string more = "-v DEBUG --only-first-n 40";
    ASSERT_EQ(slam(kSample, usual, more).exit_code, 0);
    const ProgramRun run = runProgram(
        "sh -c '" TAUT_SLAM " -i " + kSample + " -o " + closed + " --no-pictures --threads 1 " +
            more + " <&- >&- 2>&-'",
        "");
    ASSERT_EQ(run.exit_code, 0);
    for (const char* file :
         {"trajectory.tum", "trajectory_kitti.txt", "states.csv", "map.ply", "map.ot", "map.bt",
          "config.yaml"})
        EXPECT_TRUE(contentOf(usual + "/" + file) == contentOf(closed + "/" + file)) << file;
    EXPECT_THAT(contentOf(closed + "/timing.csv"), testing::Not(HasSubstr("iterations,")));
    EXPECT_EQ(contentOf(closed + "/metrics.json").front(), '{');
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

TEST(TheCommandLine, GivesTwoForWhateverIsSetWrongly)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "nan.yaml") << "lidar: {pose: {x: .nan}}\n";
    std::ofstream(folder / "empty.yaml") << "estimation:\n";
    const std::string imported = TAUT_PROGRAMS "/taut-import " TAUT_BAGS "/rosbag_none.bag -o ";
    for (const std::string wrong :
         {"--from-time 1e10", "--to-time nan", "--lidar '['", "--imu '('", "-c TEMPORARY",
          "-r TEMPORARY", "-r TEMPORARY/nan.yaml", "-c /none.yaml", "-r /none.yaml", "-p /none.so",
          "-s features.voxel_size=nan", "-s estimation.max_iterations=1e99"})
    {
        std::string arguments = wrong;
        if (const auto at = arguments.find("TEMPORARY"); at != std::string::npos)
            arguments.replace(at, 9, folder / "");
        const ProgramRun run = slam(kSample, folder / "out", arguments);
        EXPECT_EQ(run.exit_code, 2) << wrong << ": " << run.output;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    EXPECT_EQ(runProgram(imported + (folder / "x") + " --lidar-topic '['", "").exit_code, 2);
    EXPECT_EQ(slam("--show-config -c " + (folder / "empty.yaml")).exit_code, 0);
}

TEST(TheCommandLine, SetsKeysAtAnyDepthAndOtherClasses)
{
    const ProgramRun run = slam(
        "--show-config -s output.occupancy.resolution=0.5 -s features.sectors=9 "
        "-s features.type=taut::CurvatureExtractor");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("    resolution: 0.5 "));
    EXPECT_THAT(run.output, HasSubstr("  sectors: 9 "));
    for (const char* wrong : {"features=3", "features.voxel_size", "estimation.balance.x=1"})
        EXPECT_EQ(slam(std::string("--show-config -s ") + wrong).exit_code, 2) << wrong;
}

TEST(TheCommandLine, ShowsTheConfigurationAndDoesNothingElse)
{
    const TemporaryFolder folder;
    const std::string show = "--show-config -c " TAUT_CONFIG "/paper.yaml -s lidar.max_range=7";
    const ProgramRun run = slam(show);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.output, slam(kSample, folder / "out", show).output);
    EXPECT_THAT(run.output, HasSubstr("type: 'taut::KdTreeMap'"));
    EXPECT_THAT(run.output, HasSubstr("max_range: 7 "));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}
}  // namespace
