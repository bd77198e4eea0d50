/** A session beside sensors. */
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "player.h"
#include "recording.h"
#include "taut/core/Yaml.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Session.h"
#include "taut/session/registerSession.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class LiveSession : public ::testing::Test
{
 protected:
    LiveSession()
    {
        registerSession();
        registerRenderers();
        // Submaps as short as a recording of some seconds asks for.
        ConfigSection root(
            parseYaml("{slam: {submap: {min_duration: 0.8, max_duration: 1, "
                      "min_length: 0.1, length_share: 0.01}}, "
                      "initialization: {rest_duration: 1.2}}"));
        config.method = Method::read(root, std::nullopt);
        config.pictures = config.report = false;
        recording.swing = 0.3;
        imu = recording.imu();
        scans = recording.scans();
    }

    SessionOutcome run(const std::string& name)
    {
        config.folder = folder / name;
        std::filesystem::create_directory(config.folder);
        Player player(imu, scans);
        Session session(config, warnings, events);
        return session.run(player, [](double) { return true; });
    }

    nlohmann::json metrics() const
    {
        return nlohmann::json::parse(contentOf(config.folder + "/metrics.json"));
    }

    TemporaryFolder folder;
    Recording recording;
    ImuSamples imu;
    std::vector<Scan> scans;
    SessionConfig config;
    WarningLog warnings;
    EventSink events;
};
}  // namespace

TEST_F(LiveSession, LeavesWhatAnyOtherLeaves)
{
    const SessionOutcome offline = run("offline");
    EXPECT_FALSE(offline.live);
    EXPECT_FALSE(metrics().contains("live"));
    ASSERT_GT(offline.submaps, 2u);  // else the thread beside has nothing to do
    config.live = LiveConfig{[](const Scan&) { return std::optional(0.02); }, false};
    const SessionOutcome live = run("live");
    EXPECT_EQ(live.failure, "");
    EXPECT_EQ(live.submaps, offline.submaps);
    for (const char* name :
         {"trajectory.tum", "trajectory_odometry.tum", "states.csv", "map.ply", "graph.g2o",
          "loops.csv", "submaps/00000.tsm", "submaps/00001.tsm"})
    {
        const std::string expected = contentOf(folder / (std::string("offline/") + name));
        EXPECT_FALSE(expected.empty()) << name;
        EXPECT_TRUE(contentOf(folder / (std::string("live/") + name)) == expected) << name;
    }
    ASSERT_TRUE(live.live);
    EXPECT_NEAR(live.live->median, 0.02, 1e-6);
    EXPECT_GT(live.live->load, 0);
    EXPECT_NEAR(metrics()["live"]["latency_ms"]["percentile_99"].get<double>(), 20, 1e-3);
    EXPECT_TRUE(metrics()["live"]["reduced"].empty());
}

TEST_F(LiveSession, DoesLessAndSaysSoWherePosesGetLater)
{
    std::vector<int> features;
    events = [&](const Event& event)
    {
        if (const auto* estimated = std::get_if<Estimated>(&event))
            features.push_back(estimated->result.report.features);
    };
    double age = 0;
    config.live = LiveConfig{[&](const Scan&) { return std::optional(age += 0.1); }, true};
    const SessionOutcome live = run("late");
    EXPECT_TRUE(live.partly);
    EXPECT_GE(warnings.count("too_slow"), 1u);
    ASSERT_GT(features.size(), 25u);
    EXPECT_LT(features.back(), 0.8 * features.front());
    ASSERT_FALSE(live.live->reduced.empty());
    EXPECT_EQ(live.live->reduced[0].share, 0.7);
    EXPECT_EQ(metrics()["live"]["reduced"][0]["share"], 0.7);
    EXPECT_EQ(metrics()["warnings"]["too_slow"], warnings.count("too_slow"));
    // Less is not wrong.
    std::ifstream file(config.folder + "/trajectory.tum");
    std::string line, last;
    while (std::getline(file, line)) last = line;
    double t = 0, x = 0, y = 0, z = 0;
    std::istringstream(last) >> t >> x >> y >> z;
    const Vector3d truth = recording.truth(fromSeconds(t)).T_world_imu.p;
    EXPECT_NEAR((Vector3d(x, y, z) - truth).norm(), 0, 0.03);
}

TEST_F(LiveSession, TellsAFailureOfTheThreadBeside)
{
    config.live = LiveConfig{};
    config.folder = folder / "run";
    std::filesystem::create_directory(config.folder);
    Player player(imu, scans);
    Session session(config, warnings);
    int asked = 0;
    const SessionOutcome outcome = session.run(
        player,
        [&](double)
        {
            if (asked++ == 0) std::filesystem::remove_all(config.folder + "/submaps");
            return true;
        });
    EXPECT_NE(outcome.failure, "");
    EXPECT_GT(outcome.poses, 0);
}
