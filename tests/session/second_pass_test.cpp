#include "taut/session/SecondPass.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "player.h"
#include "recording.h"
#include "taut/odometry/Pipeline.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Method.h"
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

/** A recording with what the odometry made of it, and the map of the first pass. */
class ASecondPass : public ::testing::Test
{
 protected:
    ASecondPass()
    {
        registerSession();
        registerRenderers();
        ConfigSection root;
        method = Method::read(root, std::nullopt);
        method.odometry.initialization.rest_duration = 1.2;
        recording.swing = 0.3;
        recording.duration = 4;
        imu = recording.imu();
        scans = recording.scans();
    }

    std::string folderOf(const std::string& name) const
    {
        std::filesystem::create_directories(folder / name);
        return folder / name;
    }

    void firstPass()
    {
        MapExport map(method.map_export, folderOf("first"));
        Executor executor;
        Pipeline pipeline(
            method.odometry, executor, {},
            [&](const Event& event)
            {
                const auto* refined = std::get_if<Refined>(&event);
                if (refined == nullptr) return;
                if (records.empty()) path.push_back(refined->sweep.begin.T_world_imu);
                records.emplace_back(refined->sweep, refined->state);
                path.push_back(refined->state.T_world_imu);
                map.add(refined->state, refined->points());
            });
        Player player(imu, scans);
        while (auto m = player.next())
            std::visit([&](auto&& value) { pipeline.add(std::move(value)); }, std::move(*m));
        pipeline.finish();
        map.finish({});
    }

    std::string mapAlong(const std::vector<SweepRecord>& states, const std::string& name)
    {
        MapExport map(method.map_export, folderOf(name));
        Player again(imu, scans);
        EXPECT_TRUE(
            undistortAgain(again, method.odometry, states, map, [](double) { return true; }));
        map.finish({});
        return contentOf(folder / (name + "/map.ply"));
    }

    TemporaryFolder folder;
    Method method;
    Recording recording;
    ImuSamples imu;
    std::vector<Scan> scans;
    std::vector<SweepRecord> records;
    std::vector<Pose> path;  // one more than records
};
}  // namespace

TEST_F(ASecondPass, AlongTheSamePathGivesTheSameBits)
{
    firstPass();
    EXPECT_EQ(mapAlong(records, "again"), contentOf(folder / "first/map.ply"));
}

TEST_F(ASecondPass, AGyroAtTheEndOfItsRangeHidesTheSameInBoth)
{
    method.odometry.imu_range.gyro = 0.3;
    for (ImuSample& s : imu) s.gyro = s.gyro.cwiseMin(0.3).cwiseMax(-0.3);
    firstPass();
    EXPECT_EQ(mapAlong(records, "again"), contentOf(folder / "first/map.ply"));
}

TEST_F(ASecondPass, WithoutAnImuGivesTheSameBits)
{
    imu.clear();
    firstPass();
    EXPECT_EQ(mapAlong(records, "again"), contentOf(folder / "first/map.ply"));
}

TEST_F(ASecondPass, AlongAPathThatIsMovedAsAWholeMovesThePoints)
{
    firstPass();
    const Pose by{expSO3({0, 0, 0.7}), {3, -2, 1}};
    std::vector<Pose> moved;
    for (const Pose& pose : path) moved.push_back(by * pose);
    std::size_t at = 0;
    double largest = 0;
    const std::vector<SweepRecord> states = corrected(records, moved);
    std::vector<Vector3d> before;
    for (const bool is_moved : {false, true})
    {
        at = 0;
        std::size_t next = 0;
        SweepReplay replay(
            method.odometry,
            [&]() -> std::optional<SweepRecord>
            {
                const auto& of = is_moved ? states : records;
                return next < of.size() ? std::optional(of[next++]) : std::nullopt;
            },
            [&](const Sweep& sweep)
            {
                for (const Vector3d& p : sweep.undistorted(sweep.begin, sweep.end))
                {
                    if (!is_moved)
                        before.push_back(p);
                    else
                        largest = std::max(largest, (by * before.at(at++) - p).norm());
                }
            });
        Player again(imu, scans);
        while (auto m = again.next()) replay.add(std::move(*m));
        replay.finish();
        EXPECT_EQ(replay.sweeps(), records.size());
    }
    EXPECT_EQ(at, before.size());
    // Gravity stays the world's while the path turns about the vertical: all else turns with it.
    EXPECT_LT(largest, 1e-9);
}

TEST_F(ASecondPass, IsStoppedWhenAsked)
{
    firstPass();
    MapExport map(method.map_export, folderOf("stopped"));
    Player again(imu, scans);
    int asked = 0;
    EXPECT_FALSE(undistortAgain(
        again, method.odometry, records, map, [&](double) { return ++asked < 100; }));
    EXPECT_EQ(asked, 100);
}
