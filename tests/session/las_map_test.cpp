#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "las_reader.h"
#include "player.h"
#include "recording.h"
#include "taut/core/Yaml.h"
#include "taut/files/PlyFile.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Session.h"
#include "taut/session/registerSession.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** What adjusted standard GPS time is behind UNIX time: 18 leap seconds. */
constexpr double kBehind = 315'964'800 - 18 + 1e9;

Method method()
{
    registerSession();
    registerRenderers();
    ConfigSection root;
    Method m = Method::read(root, std::nullopt);
    m.odometry.initialization.rest_duration = 1.2;
    return m;
}

void expectSamePoints(const LasFile& las, const std::vector<PlyPoint>& ply)
{
    ASSERT_EQ(las.points(), ply.size());
    for (std::size_t i = 0; i < ply.size(); i++)
        for (std::size_t axis = 0; axis < 3; axis++)
            ASSERT_NEAR(las.coordinate(i, axis), ply[i].position[static_cast<int>(axis)], 6e-4);
}
}  // namespace

TEST(ALasMap, HasThePointsOfThePlyFileWithTheirTimes)
{
    Recording recording;
    recording.swing = 0.3;
    recording.duration = 3;
    const TemporaryFolder folder;
    const auto scans = recording.scans();
    SessionConfig config;
    config.method = method();
    config.pictures = config.report = false;
    const auto run = [&](const char* name)
    {
        config.folder = folder / name;
        std::filesystem::create_directory(config.folder);
        WarningLog warnings;
        Player player(recording.imu(), scans);
        EXPECT_EQ(Session(config, warnings).run(player, [](double) { return true; }).failure, "");
        EXPECT_EQ(warnings.count("las_range"), 0U);
        return config.folder;
    };
    EXPECT_FALSE(std::filesystem::exists(run("without") + "/map.las"));
    config.method.map_export.las = true;
    const std::string out = run("with");
    const LasFile las(out + "/map.las");
    const auto ply = readPlyPoints(out + "/map.ply");
    ASSERT_GT(ply.size(), 1000U);
    expectSamePoints(las, ply);
    // Each within its sweep, and not all at its end.
    std::size_t between = 0;
    for (std::size_t i = 0; i < las.points(); i++)
    {
        const double t = las.time(i) + kBehind;
        ASSERT_GE(t, toSeconds(scans.front().stamp) - 1e-3);
        ASSERT_LE(t, toSeconds(scans.back().end) + 1e-3);
        const double phase = (t - toSeconds(recording.start)) * 10;
        if (std::abs(phase - std::round(phase)) > 0.05) between++;
    }
    EXPECT_GT(between, las.points() / 2);
}

TEST(ALasMap, GivesUpThePointsThatAreTakenOut)
{
    const TemporaryFolder folder;
    MapExportConfig config;
    config.las = true;
    MapExport map(config, folder / ".");
    NavState state;
    state.t = Time{1'700'000'000} * 1'000'000'000;
    Scan raw;
    raw.stamp = state.t;
    std::vector<Vector3d> points;
    for (int i = 0; i < 20; i++)
    {
        points.emplace_back(i, 0.5, 1);
        if (i == 2) points.emplace_back(3e6, 0, 0);  // no millimetres that far
    }
    for (std::size_t i = 0; i < points.size(); i++)
    {
        LidarPoint p;
        p.intensity = static_cast<float>(i);
        p.offset = static_cast<std::int32_t>(i) * 1'000'000;
        raw.points.push_back(p);
    }
    map.add(state, points, raw);
    WarningLog warnings;
    map.finish(warnings.sink());
    EXPECT_EQ(warnings.count("las_range"), 1U);
    EXPECT_EQ(LasFile(folder / "map.las").points(), 20U);
    EXPECT_EQ(map.takeOut([](const Vector3d& p) { return p.x() > 4.5 && p.x() < 15.5; }), 11U);
    const LasFile las(folder / "map.las");
    ASSERT_EQ(las.points(), 9U);
    EXPECT_DOUBLE_EQ(las.coordinate(4, 0), 4);
    EXPECT_DOUBLE_EQ(las.coordinate(5, 0), 16);
    EXPECT_EQ(las.intensity(5), 17 * 257);
    EXPECT_NEAR(las.time(5) + kBehind - 1'700'000'000, 0.017, 1e-6);
    EXPECT_DOUBLE_EQ(las.max(0), 19);
    std::filesystem::create_directory(folder / "other");
    map.moveTo(folder / "other");
    EXPECT_EQ(LasFile(folder / "other/map.las").points(), 9U);
}
