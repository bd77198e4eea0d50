#include "taut/core/VoxelSet.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "numeric.h"
#include "taut/core/Geometry.h"

using namespace taut;
using namespace taut::test;

TEST(VoxelSet, HoldsWhatASetOfKeysHolds)
{
    VoxelSet voxels;
    std::set<std::uint64_t> reference;
    Random random(5);
    for (int i = 0; i < 20000; i++)
    {
        const std::uint64_t voxel = voxelKey(Vector3d(random.vector(3)), 1.0);
        if (i % 3 == 2)
        {
            voxels.erase(voxel);
            reference.erase(voxel);
        }
        else
        {
            EXPECT_EQ(voxels.insert(voxel), reference.insert(voxel).second);
        }
    }
    EXPECT_EQ(voxels.size(), reference.size());
    for (int x = -20; x < 20; x++)
        for (int y = -20; y < 20; y++)
            for (int z = -20; z < 20; z++)
            {
                const std::uint64_t voxel = voxelKey(Vector3d(x, y, z), 1.0);
                EXPECT_EQ(voxels.contains(voxel), reference.count(voxel) == 1);
            }
    voxels.clear();
    EXPECT_EQ(voxels.size(), 0u);
    EXPECT_FALSE(voxels.contains(*reference.begin()));
}

TEST(VoxelSet, KnowsVoxelsApartAtTheEndsOfAKey)
{
    VoxelSet voxels;
    const double far = (1 << 20) - 0.5;
    for (const double x : {-far, -0.5, 0.5, far})
        for (const double y : {-far, -0.5, 0.5, far})
            for (const double z : {-far, -0.5, 0.5, far})
                EXPECT_TRUE(voxels.insert(voxelKey(Vector3d(x, y, z), 1.0)));
    EXPECT_EQ(voxels.size(), 64u);
}

TEST(VoxelSet, CoarserHoldsTheVoxelsOfTwiceTheEdge)
{
    VoxelSet fine, coarse;
    Random random(4);
    std::vector<Vector3d> points;
    for (int i = 0; i < 20'000; i++) points.push_back(random.vector(20));
    for (const Vector3d& p : points)
    {
        fine.insert(voxelKey(p, 10.0));
        coarse.insert(voxelKey(p, 5.0));
    }
    const VoxelSet parents = fine.coarser();
    EXPECT_EQ(parents.size(), coarse.size());
    for (const Vector3d& p : points) ASSERT_TRUE(parents.contains(voxelKey(p, 5.0)));
}
