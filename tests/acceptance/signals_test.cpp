/** What signals do to the programs. */
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "slam_program.h"
#include "taut/files/PlyFile.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;

/** Runs a program in a process of its own, with the signals at their defaults. */
class Child
{
 public:
    /** The program's path and its arguments; its standard error goes to `error`, if that is one. */
    explicit Child(std::vector<std::string> words, int error = -1, bool ignore_hangup = false)
        : pid_(fork())
    {
        if (pid_ != 0) return;
        std::signal(SIGHUP, ignore_hangup ? SIG_IGN : SIG_DFL);
        if (error >= 0) dup2(error, STDERR_FILENO);
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(127);
    }

    void send(int signal) const { kill(pid_, signal); }

    /** Waits until it reads a pipe; the descriptor to write into that, or -1 if it never does. */
    int waitForReader(const std::string& pipe) const
    {
        for (int i = 0; i < 10'000; i++)
        {
            const int writer = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
            if (writer >= 0) return writer;
            usleep(1000);
        }
        return -1;
    }

    /** Its status, as of waitpid(). */
    int wait() const
    {
        int status = 0;
        waitpid(pid_, &status, 0);
        return status;
    }

    /** Sends a signal again and again until it has ended; its status. Kills it in the end. */
    int sendUntilEnd(int signal) const
    {
        int status = 0;
        for (int i = 0; i < 10'000; i++)
        {
            send(signal);
            if (waitpid(pid_, &status, WNOHANG) == pid_) return status;
            usleep(1000);
        }
        send(SIGKILL);
        return wait();
    }

 private:
    pid_t pid_;
};

/** A run that is sent a signal as soon as some scans are matched. */
class SignalledRun : public testing::Test
{
 protected:
    /** The exit code; -1 if the signal ended it. */
    int run(int signal, bool ignore_hangup, int scans = 1)
    {
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        fcntl(ends[0], F_SETFD, FD_CLOEXEC);
        const Child child(
            {TAUT_SLAM, "-i", kSample, "-o", out_, "--no-pictures", "-v", "DEBUG"}, ends[1],
            ignore_hangup);
        close(ends[1]);
        char buffer[256];
        bool sent = false;
        const auto matched = [this] { return std::count(said_.begin(), said_.end(), '\n'); };
        while (const auto n = read(ends[0], buffer, sizeof buffer))  // a line a scan
        {
            if (n < 0) break;
            said_.append(buffer, static_cast<std::size_t>(n));
            if (sent || matched() < scans + 1) continue;  // before them one of the rest
            child.send(signal);
            sent = true;
        }
        close(ends[0]);
        EXPECT_TRUE(sent) << said_;
        const int status = child.wait();
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    const TemporaryFolder folder_;
    const std::string out_ = folder_ / "out";
    std::string said_;
};

class AnInterruptedRun : public SignalledRun, public testing::WithParamInterface<int>
{
};

TEST_P(AnInterruptedRun, SavesWhatWasDone)
{
    ASSERT_EQ(run(GetParam(), false), 3) << said_;
    const auto poses = readTum(out_ + "/trajectory.tum").size();
    EXPECT_GE(poses, 1U);
    EXPECT_LT(poses, 124U);
    const auto metrics = nlohmann::json::parse(contentOf(out_ + "/metrics.json"));
    EXPECT_EQ(metrics["result"]["interrupted"], true);
    EXPECT_EQ(metrics["result"]["poses"], poses);
    EXPECT_GT(readPlyPoints(out_ + "/map.ply").size(), 0U);
    EXPECT_TRUE(std::filesystem::exists(out_ + "/map.bt"));
    EXPECT_TRUE(std::filesystem::exists(out_ + "/states.csv"));
}

std::string nameOfSignal(const testing::TestParamInfo<int>& test)
{
    return test.param == SIGINT ? "Interrupt" : test.param == SIGTERM ? "Terminate" : "HangUp";
}

INSTANTIATE_TEST_SUITE_P(By, AnInterruptedRun, testing::Values(SIGTERM, SIGHUP), nameOfSignal);

TEST(ARunWhoseFileReachesItsLimit, SavesTheRestAndNamesTheCause)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    const ProgramRun run = runProgram(  // blocks of 512 bytes: 1.5 MB; the map has more
        "sh -c 'ulimit -f 3000; " TAUT_SLAM " -i " + kSample + " -o " + out +
            " --no-pictures --threads 1 -s output.point_spacing=0.01'",
        "");
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(run.output.find("map.ply' cannot be written: File too large"), std::string::npos)
        << run.output;
    const auto poses = readTum(out + "/trajectory.tum").size();
    EXPECT_GE(poses, 1U);
    EXPECT_EQ(nlohmann::json::parse(contentOf(out + "/metrics.json"))["result"]["poses"], poses);
    EXPECT_GT(readPlyPoints(out + "/map.ply").size(), 50'000U);
}

TEST_F(SignalledRun, ThatIsKilledLeavesWhatWasDone)
{
    EXPECT_EQ(run(SIGKILL, false, 10), -1);
    const auto poses = readTum(out_ + "/trajectory.tum").size();
    EXPECT_GE(poses, 8U);
    EXPECT_GT(readPlyPoints(out_ + "/map.ply").size(), 1000U);
    EXPECT_EQ(
        readTum(out_ + "/trajectory.tum").size(), readKitti(out_ + "/trajectory_kitti.txt").size());
}

using ARunUnderNohup = SignalledRun;

TEST_F(ARunUnderNohup, GoesOnWhenTheTerminalHangsUp)
{
    EXPECT_EQ(run(SIGHUP, true), 0) << said_;
    EXPECT_EQ(readTum(out_ + "/trajectory.tum").size(), 124U);
}

/** A program that catches signals as all do, and then hangs: it reads a pipe into which nobody
 * writes. */
using AHangingProgram = testing::TestWithParam<int>;

TEST_P(AHangingProgram, IsEndedByTheSecondSignal)
{
    const TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const Child child({TAUT_HANGING_PROGRAM, pipe});
    const int writer = child.waitForReader(pipe);
    EXPECT_GE(writer, 0);
    const int status = child.sendUntilEnd(GetParam());
    close(writer);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    By, AHangingProgram, testing::Values(SIGINT, SIGTERM, SIGHUP), nameOfSignal);
}  // namespace
