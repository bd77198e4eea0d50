#include "taut/map/StatisticsTree.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr double kLeaf = 0.1;
constexpr unsigned kDepth = 16;

/** A tree whose nodes hold statistics from the given depth down. */
struct FilledTree
{
    StatisticsTree tree{kLeaf};
    unsigned from_depth = 12;

    bool add(const Eigen::Vector3d& p, double capacity = 1e9)
    {
        PointStatistics statistics;
        statistics.add(p);
        StatisticsTree::Cursor cursor(tree);
        return tree.add(cursor, keyOf(p), statistics, from_depth, capacity);
    }

    octomap::OcTreeKey keyOf(const Eigen::Vector3d& p) const
    {
        return tree.coordToKey(p.x(), p.y(), p.z());
    }

    const StatisticsNode* find(const Eigen::Vector3d& p, unsigned depth) const
    {
        return StatisticsTree::Cursor(tree).find(keyOf(p), depth);
    }
};
}  // namespace

TEST(PointStatistics, GivesMeanAndScatterOfThePoints)
{
    Random random(1);
    std::vector<Eigen::Vector3d> points;
    PointStatistics all, first, second;
    for (int i = 0; i < 200; i++)
    {
        points.emplace_back(Eigen::Vector3d(3, -8, 1) + random.vector(0.5));
        all.add(points.back());
        (i < 70 ? first : second).add(points.back());
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p / 200;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
    EXPECT_EQ(all.count, 200);
    EXPECT_LT((all.mean() - mean).norm(), 1e-12);
    EXPECT_LT((all.scatter() - scatter).norm(), 1e-9);

    first.add(second);  // sums over disjoint sets add up
    EXPECT_EQ(first.count, 200);
    EXPECT_LT((first.scatter() - scatter).norm(), 1e-9);
}

TEST(PointStatistics, ThicknessIsExactFarFromTheOrigin)
{
    Random random(2);
    PointStatistics far;
    const Eigen::Vector3d center(10'000, -7'000, 300);
    for (int i = 0; i < 1000; i++)
        far.add(
            center +
            Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.01 * random.normal()));
    EXPECT_NEAR(std::sqrt(far.scatter()(2, 2) / far.count), 0.01, 1e-3);
}

TEST(StatisticsTree, InnerNodesAreTheSumOfTheirLeaves)
{
    FilledTree filled;
    Random random(3);
    PointStatistics all;
    for (int i = 0; i < 500; i++)
    {
        // Within one node of depth 12: 16 leaves, 1.6 m.
        const Eigen::Vector3d p(
            random.uniform(0.01, 1.59), random.uniform(0.01, 1.59), random.uniform(0.01, 1.59));
        EXPECT_TRUE(filled.add(p));
        all.add(p);
    }
    const StatisticsNode* node = filled.find({0.5, 0.5, 0.5}, 12);
    ASSERT_TRUE(node);
    EXPECT_EQ(node->statistics().count, 500);
    EXPECT_LT((node->statistics().sum - all.sum).norm(), 1e-9);
    EXPECT_LT((node->statistics().moments - all.moments).norm(), 1e-9);
    ASSERT_TRUE(filled.find({0.5, 0.5, 0.5}, 11));
    EXPECT_EQ(filled.find({0.5, 0.5, 0.5}, 11)->statistics().count, 0);  // above from_depth
}

TEST(StatisticsTree, ACursorFindsWhatAFreshLookUpFinds)
{
    FilledTree filled;
    Random random(4);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 300; i++)
    {
        points.push_back(random.vector(3));
        filled.add(points.back());
    }
    StatisticsTree::Cursor cursor(filled.tree);
    for (int i = 0; i < 3000; i++)
    {
        const auto at = static_cast<std::size_t>(random.uniform(0, 299.9));
        const Eigen::Vector3d p = points[at] + random.vector(i % 2 == 0 ? 0.0 : 0.2);
        const auto depth = static_cast<unsigned>(random.uniform(12, 16.99));
        const StatisticsNode* expected = filled.tree.search(filled.keyOf(p), depth);
        EXPECT_EQ(cursor.find(filled.keyOf(p), depth), expected);
    }
    const StatisticsTree empty(kLeaf);
    EXPECT_EQ(StatisticsTree::Cursor(empty).find(filled.keyOf({0, 0, 0}), 12), nullptr);
}

TEST(StatisticsTree, AFullLeafStaysAsItIs)
{
    FilledTree filled;
    const Eigen::Vector3d p(0.55, 0.55, 0.55);
    for (int i = 0; i < 3; i++) EXPECT_TRUE(filled.add(p, 3));
    EXPECT_FALSE(filled.add(p, 3));
    EXPECT_EQ(filled.find(p, kDepth)->statistics().count, 3);
    EXPECT_EQ(filled.find(p, 12)->statistics().count, 3);
    EXPECT_TRUE(filled.add(p + Eigen::Vector3d(0.1, 0, 0), 3));  // its neighbour is not full
}

TEST(StatisticsTree, RemovingANodeRemovesAllBelowIt)
{
    FilledTree filled;
    Random random(5);
    const Eigen::Vector3d here(0.8, 0.8, 0.8), there(-20, 10, 5);
    for (int i = 0; i < 200; i++) filled.add(there + random.vector(0.3));
    const std::size_t before = filled.tree.size();
    for (int i = 0; i < 500; i++) filled.add(here + random.vector(0.1));
    EXPECT_EQ(filled.tree.size(), filled.tree.calcNumNodes());
    EXPECT_GT(filled.tree.size(), before + 50);

    filled.tree.remove(filled.keyOf(here), 12);
    EXPECT_EQ(filled.find(here, 12), nullptr);
    EXPECT_EQ(filled.find(here, kDepth), nullptr);
    EXPECT_EQ(filled.tree.size(), filled.tree.calcNumNodes());
    EXPECT_EQ(filled.tree.size(), before);
    EXPECT_TRUE(filled.find(there, 12));

    filled.tree.remove(filled.keyOf({500, 0, 0}), 12);  // there is nothing
    EXPECT_EQ(filled.tree.size(), before);
}

TEST(StatisticsTree, IsEmptyAfterTheLastNodeIsRemoved)
{
    FilledTree filled;
    const Eigen::Vector3d p(0.55, 0.55, 0.55);
    filled.add(p);
    filled.tree.remove(filled.keyOf(p), 12);
    EXPECT_EQ(filled.tree.size(), 0u);
    EXPECT_TRUE(filled.add(p));
    EXPECT_EQ(filled.tree.size(), filled.tree.calcNumNodes());
}

TEST(StatisticsTree, CopiesAreIndependent)
{
    FilledTree filled;
    const Eigen::Vector3d p(0.55, 0.55, 0.55);
    filled.add(p);
    const FilledTree copy = filled;
    filled.add(p);
    EXPECT_EQ(copy.find(p, 12)->statistics().count, 1);
    filled.tree.clear();
    EXPECT_EQ(copy.find(p, kDepth)->statistics().count, 1);
    EXPECT_EQ(copy.tree.size(), copy.tree.calcNumNodes());
}
