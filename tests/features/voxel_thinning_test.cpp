#include "taut/features/VoxelThinning.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes.h"
#include "taut/core/Voxel.h"

using namespace taut;
using namespace taut::test;

TEST(Voxel, KeysTellVoxelsApartOnBothSidesOfZero)
{
    const auto key = [](double x, double y, double z)
    { return voxelKey(Vector3d(x, y, z), 1 / 0.5); };
    EXPECT_EQ(key(0.1, 0.2, 0.3), key(0.4, 0.4, 0.4));
    EXPECT_NE(key(0.1, 0, 0), key(-0.1, 0, 0));
    EXPECT_NE(key(0.1, 0, 0), key(0, 0.6, 0));
    EXPECT_NE(key(0, 0.6, 0), key(0, 0, 0.6));
    EXPECT_EQ(key(1e12, 0, 0), key(1e15, 0, 0)) << "what is too far shares a voxel";
    EXPECT_NE(key(1e12, 0, 0), key(-1e12, 0, 0));
}

TEST(VoxelThinning, KeepsOnePointAVoxel)
{
    const Scan scan = SpinningLidar{}.scan(Scene{});
    VoxelThinning::Config config;
    config.min_points = 0;
    config.max_points = 5000;
    const Features features = VoxelThinning(config).extract(scan, {});

    std::vector<std::uint64_t> of_points, of_features;
    for (const auto& p : scan.points) of_points.push_back(voxelKey(p.position, 1 / 0.3f));
    for (const auto& f : features.points) of_features.push_back(voxelKey(f.position, 1 / 0.3f));
    for (auto* keys : {&of_points, &of_features}) std::sort(keys->begin(), keys->end());
    of_points.erase(std::unique(of_points.begin(), of_points.end()), of_points.end());
    EXPECT_EQ(of_points, of_features);
}

TEST(VoxelThinning, GrowsTheVoxelWhereThereAreTooManyPoints)
{
    const Scan scan = SpinningLidar{64, 1024, -25, 15}.scan(Scene{});
    VoxelThinning::Config config;
    config.min_points = 0;
    config.max_points = 400;
    const Features features = VoxelThinning(config).extract(scan, {});
    EXPECT_LE(features.points.size(), 400u);
    EXPECT_GE(features.points.size(), 250u);
    // Spread over the room, not drawn from its dense parts.
    int far = 0;
    for (const auto& f : features.points) far += f.position.head<2>().norm() > 6;
    EXPECT_GE(far, 100);
}

TEST(VoxelThinning, TakesTheWholeScanWhereVoxelsCannotGiveEnough)
{
    Scan scan = SpinningLidar{}.scan(Scene{});
    scan.points.resize(900);
    for (auto& p : scan.points) p.position = {1, 2, 3};  // one voxel, however small
    bool warned = false;
    const Features features = VoxelThinning().extract(scan, [&](const Warning&) { warned = true; });
    EXPECT_EQ(features.points.size(), 900u);
    EXPECT_FALSE(warned);
}

TEST(VoxelThinning, FavoursNoPartOfTheSweepAndNoSignOfTheNoise)
{
    // A wall 0.05 m beyond a voxel's border: a choice by position would prefer one side of it.
    Random random(3);
    Scan scan;
    scan.end = 100'000'000;
    for (int i = 0; i < 60000; i++)
    {
        LidarPoint p;
        const double x = 9.05 + 0.015 * random.normal();
        p.position = Vector3d(x, random.uniform(-9, 9), random.uniform(-3, 3)).cast<float>();
        p.offset = static_cast<std::int32_t>(random.uniform(0, 1e8));
        scan.points.push_back(p);
    }
    const Features features = VoxelThinning().extract(scan, {});
    double mean = 0, time = 0;
    for (const auto& f : features.points)
    {
        mean += f.position.x() - 9.05;
        time += f.offset;
    }
    const auto n = static_cast<double>(features.points.size());
    ASSERT_GT(n, 1100);
    EXPECT_LT(std::abs(mean / n), 4 * 0.015 / std::sqrt(n));
    EXPECT_LT(std::abs(time / n - 5e7), 4 * 1e8 / std::sqrt(12 * n));
}
