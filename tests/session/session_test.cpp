#include "taut/session/Session.h"
#include "taut/session/registerSession.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "player.h"
#include "recording.h"
#include "taut/core/Yaml.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/ResultFolder.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
class SessionTest : public ::testing::Test
{
 protected:
    SessionTest()
    {
        registerSession();
        registerRenderers();
        ConfigSection root;
        config.method = Method::read(root, std::nullopt);
        config.method.odometry.initialization.rest_duration = 1.2;
        config.folder = folder / "run";
        std::filesystem::create_directory(config.folder);
        config.pictures = false;
        recording.swing = 0.3;
        recording.duration = 4;
        imu = recording.imu();
        scans = recording.scans();
    }

    std::size_t linesOf(const std::string& name) const
    {
        std::ifstream file(config.folder + "/" + name);
        return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
    }

    nlohmann::json metrics() const
    {
        std::ifstream file(folder / "run/metrics.json");
        return nlohmann::json::parse(file);
    }

    TemporaryFolder folder;
    Recording recording;
    ImuSamples imu;
    std::vector<Scan> scans;
    SessionConfig config;
    WarningLog warnings;
};
}  // namespace

TEST_F(SessionTest, TellsOfAnInputWhoseNameIsNotUtf8)
{
    config.input = "caf\xe9.rawlog";
    Player player(imu, scans);
    Session session(config, warnings);
    const SessionOutcome outcome = session.run(player, [](double) { return true; });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_FALSE(outcome.report_failed);
    EXPECT_EQ(metrics()["input"]["file"], "caf\xef\xbf\xbd.rawlog");
    EXPECT_GT(std::filesystem::file_size(folder / "run/report.html"), 900'000u);
}

TEST_F(SessionTest, LeavesResultsOfAStream)
{
    Player player(imu, scans);
    std::size_t asked = 0, states = 0;
    Session session(
        config, warnings,
        [&](const Event& e) { states += std::holds_alternative<Refined>(e) ? 1 : 0; });
    const SessionOutcome outcome = session.run(player, [&](double) { return ++asked > 0; });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_FALSE(outcome.partly);
    EXPECT_EQ(outcome.poses, static_cast<int>(scans.size()));
    EXPECT_EQ(states, scans.size());
    EXPECT_EQ(asked, player.size());
    EXPECT_GE(linesOf("trajectory.tum"), scans.size());
    EXPECT_GT(outcome.map_points, 1000u);
    EXPECT_GT(std::filesystem::file_size(folder / "run/map.bt"), 100u);
    EXPECT_TRUE(metrics()["doubtful"].empty());
}

TEST_F(SessionTest, FedByHandItIsTheSame)
{
    Player player(imu, scans), again(imu, scans);
    const auto content = [&]
    {
        std::ifstream file(folder / "run/trajectory.tum");
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    Session(config, warnings).run(player, [](double) { return true; });
    const std::string by_stream = content();
    Session session(config, warnings);
    while (auto m = again.next()) session.add(std::move(*m));
    EXPECT_EQ(session.finish(again.progress(), false).poses, static_cast<int>(scans.size()));
    EXPECT_EQ(content(), by_stream);
}

TEST_F(SessionTest, SavesWhatWasDoneBeforeAStreamFailed)
{
    Player player(imu, scans);
    player.throws_at = player.size() / 2;
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_EQ(outcome.failure, "the cable was cut");
    EXPECT_GT(outcome.poses, 15);
    EXPECT_GE(linesOf("trajectory.tum"), static_cast<std::size_t>(outcome.poses));
    EXPECT_EQ(metrics()["result"]["poses"], outcome.poses);
}

TEST_F(SessionTest, AFileThatTheDiskDoesNotTakeKeepsNoneOfTheOthers)
{
    if (!std::ofstream("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    for (const char* file : {"map.ot", "loops.csv"})
        std::filesystem::create_symlink("/dev/full", config.folder + "/" + file);
    Player player(imu, scans);
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_EQ(
        outcome.failure, "cannot write '" + config.folder + "/map.ot': No space left on device");
    EXPECT_EQ(outcome.poses, static_cast<int>(scans.size()));
    EXPECT_EQ(linesOf("trajectory.tum"), scans.size() + 1);
    EXPECT_EQ(metrics()["result"]["poses"], scans.size());
    EXPECT_FALSE(std::filesystem::exists(folder / "run/.taut-reserve"));
}

TEST_F(SessionTest, NobodyElseWritesToItsFolder)
{
    {
        Session session(config, warnings);
        EXPECT_THROW(Session(config, warnings), std::runtime_error);
        EXPECT_THROW(prepareResultFolder(config.folder, true, {}), FolderInUse);
    }
    Session after(config, warnings);
}

TEST_F(SessionTest, NamesThatAreNotUtf8AreInTheMetricsAllTheSame)
{
    config.input = folder / "h\xe4ll.rawlog";
    config.method_file = "m\xfcthod.yaml";
    Player player(imu, scans);
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_EQ(metrics()["method"]["file"], "m\uFFFDthod.yaml");
}

TEST_F(SessionTest, ALaterErrorDoesNotHideTheFirst)
{
    if (!std::ofstream("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    for (const char* file : {"map.ot", "states.csv"})
        std::filesystem::create_symlink("/dev/full", config.folder + "/" + file);
    Player player(imu, scans);
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_EQ(
        outcome.failure,
        "cannot write '" + config.folder + "/states.csv': No space left on device");
    EXPECT_GE(warnings.count("not_saved"), 1u);
    EXPECT_GE(metrics()["warnings"]["not_saved"], 1);
}

TEST_F(SessionTest, AnInterruptedOneIsPartial)
{
    Player player(imu, scans);
    std::size_t left = player.size() / 2;
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [&](double) { return --left > 0; });
    EXPECT_TRUE(outcome.interrupted);
    EXPECT_TRUE(outcome.partly);
    EXPECT_GT(outcome.poses, 15);
    EXPECT_LT(outcome.poses, static_cast<int>(scans.size()));
}

TEST_F(SessionTest, AnImuThatDiesMakesItPartialAndIsTold)
{
    imu.resize(imu.size() / 2);
    Player player(imu, scans);
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_TRUE(outcome.partly);
    EXPECT_EQ(outcome.poses, static_cast<int>(scans.size()));
    const auto doubts = metrics()["doubtful"];
    ASSERT_EQ(doubts.size(), 1u);
    EXPECT_EQ(doubts[0]["cause"], "imu_silent");
    EXPECT_NEAR(doubts[0]["from"].get<double>(), toSeconds(imu.back().t), 0.3);
    EXPECT_FALSE(doubts[0]["recovered"].get<bool>());
}

TEST_F(SessionTest, ALidarThatEndsMakesItPartial)
{
    scans.resize(30);
    Player player(imu, scans);
    EXPECT_TRUE(Session(config, warnings).run(player, [](double) { return true; }).partly);
    EXPECT_EQ(warnings.count("lidar_ended"), 1u);
}

TEST_F(SessionTest, TwoAtOnceDoNotDisturbEachOther)
{
    SessionConfig other_config = config;
    other_config.folder = folder / "other";
    std::filesystem::create_directory(other_config.folder);
    Player player(imu, scans), second(imu, scans);
    WarningLog other_warnings;
    Session one(config, warnings), other(other_config, other_warnings);
    while (auto m = player.next())
    {
        one.add(*m);
        other.add(std::move(*m));
    }
    one.finish(player.progress(), false);
    other.finish(player.progress(), false);
    const auto content = [](const std::filesystem::path& path)
    {
        std::ifstream file(path);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(content(folder / "run/trajectory.tum"), content(folder / "other/trajectory.tum"));
}

namespace
{
/** Of submaps as short as a recording of some seconds asks for. */
Method methodWithShortSubmaps()
{
    ConfigSection root(
        parseYaml("{slam: {submap: {min_duration: 0.8, max_duration: 1, "
                  "min_length: 0.1, length_share: 0.01},"
                  " places: {min_way: 0.1}}, "
                  "initialization: {rest_duration: 1.2}}"));
    return Method::read(root, std::nullopt);
}

std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
}  // namespace

TEST_F(SessionTest, InAKnownMapIsToldInItsFrameAndUndistortedAgain)
{
    recording.duration = 6;
    imu = recording.imu();
    scans = recording.scans();
    config.method = methodWithShortSubmaps();
    Player first(imu, scans);
    const SessionOutcome mapped = Session(config, warnings).run(first, [](double) { return true; });
    ASSERT_GE(mapped.submaps, 4u);

    config.known_map = KnownMap{config.folder, false, {}};
    config.folder = folder / "second";
    std::filesystem::create_directory(config.folder);
    Player player(imu, scans);
    std::size_t asked = 0, second = 0;
    Session session(config, warnings);
    const SessionOutcome outcome = session.run(
        player,
        [&](double)
        {
            asked++;
            second += session.inSecondPass();
            return true;
        },
        [&] { return std::make_unique<Player>(imu, scans); });
    EXPECT_EQ(outcome.failure, "");
    EXPECT_GE(outcome.loops, 1u);
    EXPECT_TRUE(outcome.corrected);
    EXPECT_TRUE(outcome.undistorted_again);
    EXPECT_FALSE(outcome.partly);
    EXPECT_EQ(asked, 2 * player.size());
    EXPECT_EQ(second, player.size());
    EXPECT_EQ(outcome.poses, static_cast<int>(scans.size()));
    EXPECT_EQ(linesOf("trajectory.tum"), linesOf("trajectory_odometry.tum"));
    EXPECT_TRUE(
        contentOf(config.folder + "/trajectory.tum") !=
        contentOf(config.folder + "/trajectory_odometry.tum"));
    EXPECT_GE(linesOf("loops.csv"), 2u);
    for (const char* rest : {"trajectory.tum.part", "trajectory_kitti.txt.part", "map.part"})
        EXPECT_FALSE(std::filesystem::exists(config.folder + "/" + rest)) << rest;
    double farthest = 0;
    for (const StampedPose& p : readTum(config.folder + "/trajectory.tum"))
        farthest = std::max(
            farthest,
            (p.T_world_imu.p - recording.pose(toSeconds(p.t - recording.start)).p).norm());
    EXPECT_LT(farthest, 0.03);
}

TEST_F(SessionTest, WithoutAWayToReadAgainMovesThePointsOfSubmaps)
{
    config.method = methodWithShortSubmaps();
    Player first(imu, scans);
    Session(config, warnings).run(first, [](double) { return true; });
    config.known_map = KnownMap{config.folder, false, {}};
    config.folder = folder / "second";
    std::filesystem::create_directory(config.folder);
    Player player(imu, scans);
    const SessionOutcome outcome =
        Session(config, warnings).run(player, [](double) { return true; });
    EXPECT_TRUE(outcome.corrected);
    EXPECT_FALSE(outcome.undistorted_again);
    EXPECT_GT(outcome.map_points, 1000u);
}

TEST_F(SessionTest, FallsBackToTheSubmapsWhereTheSecondPassFailsOrIsStopped)
{
    config.method = methodWithShortSubmaps();
    Player first(imu, scans);
    Session(config, warnings).run(first, [](double) { return true; });
    config.known_map = KnownMap{config.folder, false, {}};
    const auto again = [&](const char* name, bool fails)
    {
        config.folder = folder / name;
        std::filesystem::create_directory(config.folder);
        Player player(imu, scans);
        Session session(config, warnings);
        return session.run(
            player, [&](double share) { return !session.inSecondPass() || share < 0.5; },
            [&]() -> std::unique_ptr<MeasurementStream>
            {
                if (fails) throw std::runtime_error("the disk is gone");
                return std::make_unique<Player>(imu, scans);
            });
    };
    const SessionOutcome failed = again("failed", true);
    EXPECT_EQ(failed.failure, "");
    EXPECT_FALSE(failed.undistorted_again);
    EXPECT_FALSE(failed.interrupted);
    EXPECT_GT(failed.map_points, 1000u);
    EXPECT_EQ(warnings.count("no_second_pass"), 1u);
    const SessionOutcome stopped = again("stopped", false);
    EXPECT_FALSE(stopped.undistorted_again);
    EXPECT_TRUE(stopped.interrupted && stopped.partly);
    EXPECT_GT(stopped.map_points, 1000u);
}

TEST_F(SessionTest, NeverWritesOverTheMapItIsJoinedTo)
{
    config.known_map = KnownMap{config.folder, false, {}};
    EXPECT_THROW(Session(config, warnings), std::runtime_error);
}

TEST_F(SessionTest, WhereNoLoopIsBelievedTheFilesAreThoseOfTheOdometry)
{
    const auto run = [&](const char* name)
    {
        config.folder = folder / name;
        std::filesystem::create_directory(config.folder);
        Player player(imu, scans);
        return Session(config, warnings).run(player, [](double) { return true; });
    };
    EXPECT_EQ(run("with").loops, 0u);
    config.method.slam.loops = false;
    EXPECT_EQ(run("without").submaps, 0u);
    for (const char* name : {"trajectory.tum", "map.ply", "map.bt", "states.csv"})
        EXPECT_EQ(
            contentOf(folder / (std::string("with/") + name)),
            contentOf(folder / (std::string("without/") + name)))
            << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "without/submaps"));
    EXPECT_TRUE(std::filesystem::exists(folder / "with/trajectory_odometry.tum"));
}
