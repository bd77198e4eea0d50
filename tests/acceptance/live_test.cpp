/** taut-live, and taut-slam on logs that are being written. */
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "data_folder.h"
#include "slam_program.h"
#include "taut/rawlog/RawlogSource.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

const std::string kPlain = " --no-pictures --no-report --threads 1 ";

/** What is in a rawlog that was perhaps cut off. */
struct Content
{
    std::size_t scans = 0, samples = 0;
    bool incomplete = false;
};
Content contentOfLog(const std::string& path)
{
    RawlogConfig config;
    config.path = path;
    RawlogSource source(config);
    while (source.next())
    {
    }
    return {source.progress().scans, source.progress().imu_samples, source.incomplete()};
}

/** Lines of JSON among others, in their order. */
std::vector<nlohmann::json> jsonOf(const std::string& text)
{
    std::vector<nlohmann::json> lines;
    std::istringstream all(text);
    for (std::string line; std::getline(all, line);)
        if (!line.empty() && line[0] == '{') lines.push_back(nlohmann::json::parse(line));
    return lines;
}

class Live : public testing::Test
{
 protected:
    ProgramRun live(const std::string& arguments)
    {
        return runProgram(TAUT_LIVE, "-o " + out_ + kPlain + arguments);
    }

    /** Starts taut-live in a process of its own. */
    pid_t start(const std::string& arguments) const
    {
        const pid_t child = fork();
        if (child != 0) return child;
        std::signal(SIGINT, SIG_DFL);
        const std::string command =
            std::string("exec ") + TAUT_LIVE + " -q -o " + out_ + kPlain + arguments;
        execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        _exit(127);
    }

    /** Waits until the log has that many bytes; false if it never does. */
    bool waitForBytes(std::uintmax_t bytes) const
    {
        for (int i = 0; i < 20'000; i++)
        {
            std::error_code error;
            const auto size = fs::file_size(log_, error);
            if (!error && size >= bytes) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    static int exitCodeOf(pid_t child)
    {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    void expectSameResults(const std::string& other) const
    {
        for (const char* name :
             {"trajectory.tum", "trajectory_odometry.tum", "states.csv", "map.ply", "loops.csv",
              "graph.g2o"})
        {
            const std::string expected = contentOf(other + "/" + name);
            EXPECT_FALSE(expected.empty()) << name;
            EXPECT_TRUE(contentOf(out_ + "/" + name) == expected) << name;
        }
    }

    const TemporaryFolder folder_;
    const std::string out_ = folder_ / "out", log_ = out_ + "/log.rawlog";
};

TEST_F(Live, LeavesTheSameToTheBitAsARunOverItsLog)
{
    const ProgramRun run = live("--replay " + kSample + " --speed 0 --never-less");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("observations recorded in " + log_));
    EXPECT_THAT(run.output, HasSubstr("poses after"));
    ASSERT_EQ(slam(log_, folder_ / "again", "--no-report").exit_code, 0);
    expectSameResults(folder_ / "again");
    ASSERT_EQ(slam(kSample, folder_ / "original", "--no-report").exit_code, 0);
    expectSameResults(folder_ / "original");
    const auto metrics = nlohmann::json::parse(contentOf(out_ + "/metrics.json"));
    EXPECT_GT(metrics["live"]["load"].get<double>(), 0);
    EXPECT_EQ(metrics["input"]["file"], log_);
}

TEST_F(Live, ClosesTheLogAndSavesAtASignal)
{
    const pid_t child = start("--replay " + kSample + " --speed 8 --never-less");
    ASSERT_TRUE(waitForBytes(2'000'000));
    kill(child, SIGTERM);
    EXPECT_EQ(exitCodeOf(child), 0);
    const Content content = contentOfLog(log_);
    EXPECT_FALSE(content.incomplete);
    EXPECT_LT(content.scans, 200u);
    ASSERT_EQ(slam(log_, folder_ / "again", "--no-report").exit_code, 0);
    expectSameResults(folder_ / "again");
}

TEST_F(Live, LeavesALogThatCanBeReadWhenItIsKilled)
{
    const pid_t child = start("--replay " + kSample + " --speed 8 --never-less");
    ASSERT_TRUE(waitForBytes(2'000'000));
    kill(child, SIGKILL);
    EXPECT_EQ(exitCodeOf(child), -1);
    const Content content = contentOfLog(log_), all = contentOfLog(kSample);
    EXPECT_TRUE(content.incomplete);
    const auto bytes = static_cast<double>(fs::file_size(log_));
    const double share = bytes / static_cast<double>(fs::file_size(kSample));
    EXPECT_NEAR(
        static_cast<double>(content.scans), share * static_cast<double>(all.scans),
        0.2 * static_cast<double>(all.scans));  // the samples differ in size
    const ProgramRun again = slam(log_, folder_ / "again", "--no-report");
    EXPECT_EQ(again.exit_code, 3) << again.output;
    EXPECT_THAT(again.output, HasSubstr("rawlog_truncated"));
    EXPECT_GT(readTum(folder_ / "again/trajectory.tum").size(), 5u);
}

TEST_F(Live, StreamsAPoseForEachScan)
{
    const ProgramRun run =
        live("--replay " + kSample + " --speed 0 --never-less --stream -s output.refined=false");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto lines = jsonOf(run.output);
    const Trajectory trajectory = readTum(out_ + "/trajectory.tum");
    ASSERT_GT(lines.size(), 10u);
    if (run.output.find("stream_behind") == std::string::npos)
    {
        ASSERT_EQ(lines.size(), trajectory.size());
    }
    const auto& last = lines.back();
    EXPECT_NEAR(last["t"].get<double>(), toSeconds(trajectory.back().t), 1e-6);
    for (std::size_t i = 0; i < 3; i++)
        EXPECT_NEAR(
            last["position"][i].get<double>(),
            trajectory.back().T_world_imu.p[static_cast<Eigen::Index>(i)], 1e-6);
    EXPECT_EQ(last["orientation_xyzw"].size(), 4u);
    EXPECT_EQ(last["velocity"].size(), 3u);
    EXPECT_GT(last["sigma_position"][0].get<double>(), 0);
    EXPECT_GT(last["sigma_rotation"][2].get<double>(), 0);
    EXPECT_EQ(last["doubtful"], false);
}

TEST_F(Live, DoesNotWaitForAReaderOfTheStream)
{
    const std::string pipe = folder_ / "pipe";
    ASSERT_EQ(runProgram("mkfifo", pipe).exit_code, 0);
    // Open for reading too, so that there is a reader, who never reads; and full from the start.
    const ProgramRun run = runProgram(
        "sh -c 'exec 3<>" + pipe + "; head -c 65000 /dev/zero >&3; timeout 60 " TAUT_LIVE " -o " +
            out_ + kPlain + "--replay " + kSample + " --speed 0 --never-less --stream 2>" +
            (folder_ / "said") + " >&3; echo code $?'",
        "");
    EXPECT_THAT(run.output, HasSubstr("code 0"));
    EXPECT_EQ(readTum(out_ + "/trajectory.tum").size(), 124u);
    EXPECT_THAT(contentOf(folder_ / "said"), HasSubstr("stream_behind"));
}

TEST_F(Live, HasALatencyThatAScriptMeasures)
{
    const ProgramRun run = runProgram(
        "TAUT_BIN=" + fs::path(TAUT_LIVE).parent_path().string() + " " TAUT_SCRIPTS "/latency.sh",
        kSample + " 1 --speed 8 --never-less");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(
        run.output, testing::ContainsRegex("\\| hall_fast.rawlog \\| 1 \\| [1-9][0-9]* \\| "
                                           "[0-9]+\\.[0-9] \\| [1-9][0-9]* \\| [1-9][0-9]* "
                                           "\\| [1-9][0-9]* \\| [1-9][0-9]* \\| 100 \\|"));
}

TEST_F(Live, NeverWritesOverARecording)
{
    fs::create_directories(out_);
    std::ofstream(log_) << "a recording";
    const ProgramRun run = live("-w --replay " + kSample);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.output, HasSubstr("is a recording, which is not written over"));
    EXPECT_EQ(contentOf(log_), "a recording");
}

TEST_F(Live, SaysPlainlyWhatIsWrong)
{
    EXPECT_THAT(live("").output, HasSubstr("SENSORS.ini or --replay is needed"));
    EXPECT_THAT(live("a.ini --replay b").output, HasSubstr("one of them only"));
    EXPECT_THAT(live("--replay b --duration 0").output, HasSubstr("--duration must be above 0"));
    EXPECT_THAT(live("--replay b --speed -1").output, HasSubstr("--speed must not be negative"));
    const ProgramRun absent = live("--replay " + (folder_ / "absent.rawlog"));
    EXPECT_EQ(absent.exit_code, 1);
    EXPECT_THAT(absent.output, HasSubstr("absent.rawlog"));
    EXPECT_FALSE(fs::exists(log_));
#ifndef TAUT_GRABBER
    EXPECT_THAT(live("sensors.ini").output, HasSubstr("built without MRPT's drivers"));
#endif
}

#ifdef TAUT_GRABBER
TEST_F(Live, RecordsTheSensorsOfACaptureFile)
{
    const fs::path pcap = dataFolder() / "pcap/ouster_os1_128.pcap";
    if (!fs::exists(pcap)) return skipWithout("ouster_os1_128.pcap");
    const std::string ini = folder_ / "sensors.ini";
    std::ofstream(ini) << "[global]\nrawlog_GZ_compress_level = 0\n"
                          "[REPLAY]\ndriver = PcapReplay\nprocess_rate = 100\nspeed = 1\n"
                          "pcap_input = "
                       << pcap.string() << "\n";
    const ProgramRun run = live(ini + " -p " TAUT_GRABBER);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("all of its 3 scans and 30 IMU samples are written"));
    const Content content = contentOfLog(log_);
    EXPECT_EQ(content.scans, 3u);
    EXPECT_EQ(content.samples, 30u);
    EXPECT_EQ(contentOf(log_).substr(0, 2) == "\x1f\x8b", false);  // not compressed, as told
    ASSERT_EQ(slam(log_, folder_ / "again", "--no-report").exit_code, 0);
    expectSameResults(folder_ / "again");
}

TEST_F(Live, SaysWhichSensorCannotBeHad)
{
    const std::string ini = folder_ / "sensors.ini";
    std::ofstream(ini) << "[TOP]\ndriver = CNoSuchSensor\nprocess_rate = 10\n";
    const ProgramRun run = live(ini);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.output, HasSubstr("sensor [TOP]: there is no driver 'CNoSuchSensor'"));
    std::ofstream(ini) << "[global]\nrawlog_prefix = x\n";
    EXPECT_THAT(live("-w " + ini).output, HasSubstr("no sensor"));
    EXPECT_THAT(live("-w none.ini").output, HasSubstr("none.ini' is not a file"));
}
#endif

/** taut-slam beside a thread that writes the sample, piece by piece. */
class Following : public Live
{
 protected:
    std::thread write(double share) const
    {
        const std::string bytes = contentOf(kSample);
        return std::thread(
            [bytes, share, path = growing_]
            {
                const auto end =
                    static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
                std::ofstream file(path, std::ios::binary | std::ios::app);
                for (std::size_t at = 0; at < end; at += 30'000)
                {
                    file << bytes.substr(at, std::min<std::size_t>(30'000, end - at)) << std::flush;
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                }
            });
    }

    const std::string growing_ = folder_ / "growing.rawlog";
};

TEST_F(Following, ReadsWhatAnotherProgramWritesUntilItGrowsNoMore)
{
    std::ofstream(growing_).close();  // there, and empty
    std::thread writer = write(1);
    const ProgramRun run = slam(growing_, out_, "--no-report --follow 1.5");
    writer.join();
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("growing.rawlog' has not grown for 1.5 s"));
    ASSERT_EQ(slam(kSample, folder_ / "whole", "--no-report").exit_code, 0);
    expectSameResults(folder_ / "whole");
}

TEST_F(Following, EndsByASignalWithAllThatWasWritten)
{
    write(0.7).join();
    const ProgramRun run = runProgram(
        "timeout --foreground --preserve-status -s TERM 2 " TAUT_SLAM,
        "-i " + growing_ + " -o " + out_ + kPlain + "--follow 1000");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("is not followed any longer"));
    EXPECT_THAT(run.output, Not(HasSubstr("rawlog_truncated")));
    const std::size_t poses = readTum(out_ + "/trajectory.tum").size();
    EXPECT_GT(poses, 50u);
    EXPECT_LT(poses, 124u);
}

TEST_F(Following, SaysSoWhereTheWriterLeftItUnfinished)
{
    write(0.7).join();
    const ProgramRun run = slam(growing_, out_, "--no-report --follow 0.2");
    EXPECT_EQ(run.exit_code, 3) << run.output;
    EXPECT_THAT(run.output, HasSubstr("rawlog_truncated"));
    EXPECT_THAT(
        slam("-i " + growing_ + " -o x --follow 0").output, HasSubstr("--follow: the seconds"));
}

TEST_F(Following, StreamsPosesWhileItReads)
{
    const ProgramRun run = slam(kSample, out_, "--no-report -q --stream");
    ASSERT_EQ(run.exit_code, 0);
    const auto lines = jsonOf(run.output);
    EXPECT_EQ(lines.size(), 124u);
    for (std::size_t i = 1; i < lines.size(); i++)
        EXPECT_GT(lines[i]["t"].get<double>(), lines[i - 1]["t"].get<double>());
}
}  // namespace
