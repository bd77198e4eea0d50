#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <limits>

#include "numeric.h"
#include "taut/map/OccupancyWorker.h"

using namespace taut;
using namespace taut::test;

namespace
{
/** Points on a round wall of that radius about a centre. */
std::vector<Vector3d> wallAround(const Vector3d& center, double radius = 5, int points = 2000)
{
    std::vector<Vector3d> wall;
    Random random(9);
    for (int i = 0; i < points; i++)
    {
        const double a = 2 * M_PI * i / points;
        wall.push_back(
            center + Vector3d(radius * std::cos(a), radius * std::sin(a), random.uniform(-1, 1)));
    }
    return wall;
}

enum class Cell
{
    Unknown,
    Free,
    Occupied
};

Cell cellAt(const octomap::OcTree& tree, const Vector3d& p)
{
    const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
    if (!node) return Cell::Unknown;
    return tree.isNodeOccupied(node) ? Cell::Occupied : Cell::Free;
}

/** Centre of the cell that holds a point: where its ray ends. */
Vector3d cellCenter(const octomap::OcTree& tree, const Vector3d& p)
{
    const auto c = tree.keyToCoord(tree.coordToKey(p.x(), p.y(), p.z()));
    return {c.x(), c.y(), c.z()};
}

std::string fileOf(const std::string& name)
{
    return ::testing::TempDir() + "taut_occupancy_" + name;
}

std::string bytesOf(const OccupancyMap& map, const std::string& name)
{
    map.writeOt(fileOf(name));
    std::ifstream file(fileOf(name), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::remove(fileOf(name).c_str());
    return bytes;
}

OccupancyMap mapOfWall(const OccupancyMap::Config& config = {})
{
    OccupancyMap map(config);
    for (int i = 0; i < 3; i++) map.insert(0, {0, 0, 0}, wallAround({0, 0, 0}), {});
    return map;
}
}  // namespace

TEST(OccupancyMap, IsWhatOctomapMakesOfTheSameRays)
{
    OccupancyMap::Config config;
    config.max_range = 6;  // some rays end before the wall
    OccupancyMap map(config);
    octomap::OcTree reference(config.resolution);
    Random random(3);
    for (int i = 0; i < 40; i++)
    {
        // Round and round: cells become certainly free, and a wall that moves fills some again.
        const Vector3d origin = random.vector(2);
        const auto wall = wallAround({0, 0, 0}, i < 30 ? 6.0 : 3.0, 500);
        map.insert(0, origin, wall, {});
        octomap::Pointcloud cloud;
        for (const Vector3d& p : wall)
            cloud.push_back(
                static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
        reference.insertPointCloud(
            cloud,
            {static_cast<float>(origin.x()), static_cast<float>(origin.y()),
             static_cast<float>(origin.z())},
            config.max_range, true, true);
    }
    reference.updateInnerOccupancy();
    reference.prune();
    EXPECT_GT(reference.size(), 5000u);
    EXPECT_TRUE(map.tree() == reference);
}

TEST(OccupancyMap, TellsOccupiedFreeAndUnknownApart)
{
    const OccupancyMap map = mapOfWall();
    int unknown = 0;
    for (const Vector3d& p : wallAround({0, 0, 0}))
    {
        EXPECT_EQ(cellAt(map.tree(), p), Cell::Occupied);
        EXPECT_EQ(cellAt(map.tree(), 1.2 * p), Cell::Unknown);
        const Cell within = cellAt(map.tree(), 0.8 * cellCenter(map.tree(), p));
        EXPECT_NE(within, Cell::Occupied);
        unknown += within == Cell::Unknown;  // where a ray runs along a border of cells
    }
    EXPECT_LT(unknown, 5);
}

TEST(OccupancyMap, LearnsOnlyFreeSpaceFromRaysBeyondItsRange)
{
    OccupancyMap::Config config;
    config.max_range = 3;
    const OccupancyMap map = mapOfWall(config);
    for (const Vector3d& p : wallAround({0, 0, 0}))
    {
        EXPECT_EQ(cellAt(map.tree(), 0.5 * cellCenter(map.tree(), p)), Cell::Free);
        EXPECT_EQ(cellAt(map.tree(), p), Cell::Unknown);
    }
}

TEST(OccupancyMap, HalvesItsResolutionRatherThanOutgrowItsNodes)
{
    OccupancyMap::Config config;
    config.max_nodes = 20000;
    OccupancyMap map(config);
    std::vector<Warning> warnings;
    for (int i = 0; i < 20; i++)
    {
        const Vector3d center(4.0 * i, 0, 0);
        map.insert(
            i + 1, center, wallAround(center), [&](const Warning& w) { warnings.push_back(w); });
        EXPECT_LE(map.tree().size(), 20000u);
    }
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings[0].kind, "occupancy_coarser");
    EXPECT_GT(warnings[0].t, 0);
    EXPECT_NEAR(map.resolution(), 0.2 * std::pow(2, warnings.size()), 1e-9);
    const Vector3d last(76, 0, 0);
    EXPECT_EQ(cellAt(map.tree(), last + Vector3d(5, 0, 0)), Cell::Occupied);
    EXPECT_EQ(cellAt(map.tree(), last + Vector3d(2, 0.3, 0)), Cell::Free);
    EXPECT_EQ(cellAt(map.tree(), last + Vector3d(12, 0, 0)), Cell::Unknown);
}

TEST(OccupancyMap, KeepsWhatItKnowsWhenItGetsCoarser)
{
    OccupancyMap::Config fine, coarse;
    coarse.max_nodes = 8000;
    const OccupancyMap before = mapOfWall(fine), after = mapOfWall(coarse);
    ASSERT_GT(before.tree().size(), 8000u);
    ASSERT_NEAR(after.resolution(), 0.4, 1e-9);
    int occupied = 0, free = 0;
    for (auto leaf = before.tree().begin_leafs(); leaf != before.tree().end_leafs(); ++leaf)
    {
        const auto c = leaf.getCoordinate();
        const Cell cell = cellAt(after.tree(), {c.x(), c.y(), c.z()});
        if (before.tree().isNodeOccupied(*leaf))
        {
            occupied++;
            EXPECT_EQ(cell, Cell::Occupied);
        }
        else
        {
            free++;
            EXPECT_NE(cell, Cell::Unknown);
        }
    }
    EXPECT_GT(occupied, 500);
    EXPECT_GT(free, 3000);
    EXPECT_EQ(cellAt(after.tree(), {2, 2, 0}), Cell::Free);
}

TEST(OccupancyMap, WritesFilesThatOctomapReadsBackEqual)
{
    const OccupancyMap map = mapOfWall();
    map.writeOt(fileOf("a.ot"));
    map.writeBt(fileOf("a.bt"));

    const std::unique_ptr<octomap::AbstractOcTree> any(
        octomap::AbstractOcTree::read(fileOf("a.ot")));
    const auto* ot = dynamic_cast<octomap::OcTree*>(any.get());
    ASSERT_TRUE(ot);
    EXPECT_TRUE(*ot == map.tree());

    octomap::OcTree bt(1);
    ASSERT_TRUE(bt.readBinary(fileOf("a.bt")));
    EXPECT_NEAR(bt.getResolution(), 0.2, 1e-12);
    for (auto leaf = map.tree().begin_leafs(); leaf != map.tree().end_leafs(); ++leaf)
    {
        const octomap::OcTreeNode* node = bt.search(leaf.getKey());
        ASSERT_TRUE(node);
        EXPECT_EQ(bt.isNodeOccupied(node), map.tree().isNodeOccupied(*leaf));
    }
    for (const char* name : {"a.ot", "a.bt"}) std::remove(fileOf(name).c_str());
}

TEST(OccupancyMap, SaysWhichFileItCannotWrite)
{
    const OccupancyMap map;
    try
    {
        map.writeOt("/nowhere/map.ot");
        FAIL() << "no error";
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_NE(std::string(e.what()).find("/nowhere/map.ot"), std::string::npos);
    }
    EXPECT_THROW(map.writeBt("/nowhere/map.bt"), std::runtime_error);
}

TEST(OccupancyMap, LeavesOutPointsItCannotHold)
{
    OccupancyMap map;
    std::vector<Warning> warnings;
    const auto warn = [&](const Warning& w) { warnings.push_back(w); };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    map.insert(7, {0, 0, 0}, {{nan, 0, 0}, {1, 1, 1}}, warn);
    EXPECT_TRUE(warnings.empty());
    map.insert(8, {0, 0, 0}, {{1e6, 0, 0}, {1, 1, 1}}, warn);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].kind, "occupancy_range");
    EXPECT_EQ(warnings[0].t, 8);
    map.insert(9, {1e6, 0, 0}, {{1, 1, 1}}, warn);
    EXPECT_EQ(warnings.size(), 2u);
    EXPECT_EQ(cellAt(map.tree(), {1, 1, 1}), Cell::Occupied);
    EXPECT_THROW(map.insert(10, {nan, 0, 0}, {{1, 1, 1}}, warn), std::invalid_argument);
}

TEST(OccupancyWorker, MakesTheSameMapAsWithoutIt)
{
    OccupancyMap::Config config;
    config.max_nodes = 20000;
    OccupancyMap alone(config);
    OccupancyWorker worker(config, 2);
    std::vector<std::string> expected, passed_on;
    for (int i = 0; i < 20; i++)
    {
        const Vector3d center(2.0 * i, 0, 0);
        alone.insert(
            i, center, wallAround(center), [&](const Warning& w) { expected.push_back(w.text); });
        worker.submit(i, center, wallAround(center));
    }
    const OccupancyMap& map = worker.finish([&](const Warning& w) { passed_on.push_back(w.text); });
    EXPECT_TRUE(map.tree() == alone.tree());
    EXPECT_EQ(bytesOf(map, "worker.ot"), bytesOf(alone, "alone.ot"));
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(expected, passed_on);
}

TEST(OccupancyWorker, RethrowsAtTheEndAndNeverBlocksAfterAFailure)
{
    OccupancyWorker worker({}, 1);
    worker.submit(1, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {{1, 0, 0}});
    for (int i = 0; i < 10; i++) worker.submit(2, {0, 0, 0}, {{1, 0, 0}});
    EXPECT_THROW(worker.finish({}), std::invalid_argument);
    EXPECT_THROW(worker.finish({}), std::invalid_argument);
}

TEST(OccupancyWorker, TakesNothingAfterItsEnd)
{
    OccupancyWorker worker({});
    worker.submit(1, {0, 0, 0}, {{1, 0, 0}});
    EXPECT_GT(worker.finish({}).tree().size(), 0u);
    EXPECT_THROW(worker.submit(2, {0, 0, 0}, {{1, 0, 0}}), std::logic_error);
    EXPECT_GT(worker.finish({}).tree().size(), 0u);
}

TEST(OccupancyWorker, CanBeDroppedWithWorkWaiting)
{
    OccupancyWorker worker({}, 50);
    for (int i = 0; i < 40; i++) worker.submit(i, {0, 0, 0}, wallAround({0, 0, 0}));
}
