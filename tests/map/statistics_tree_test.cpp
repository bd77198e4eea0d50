#include "taut/map/StatisticsTree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

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

    void add(const Eigen::Vector3d& p) { add(std::vector{p}); }

    /** Gives the way of a point in each dense node. */
    std::vector<std::uint64_t> add(
        const std::vector<Eigen::Vector3d>& points, int threads = 1,
        const StatisticsTree::DenseRule& dense_rule = {})
    {
        StatisticsTree::Entries entries;
        for (std::uint32_t i = 0; i < points.size(); i++)
            entries.push_back({StatisticsTree::mortonOf(keyOf(points[i])), i});
        Executor executor(threads);
        return tree.add(
            entries, from_depth, dense_rule,
            [&](const StatisticsTree::Entry& e, PointStatistics& sum) { sum.add(points[e.index]); },
            executor);
    }

    octomap::OcTreeKey keyOf(const Eigen::Vector3d& p) const
    {
        return tree.coordToKey(p.x(), p.y(), p.z());
    }

    const StatisticsNode* find(const Eigen::Vector3d& p, unsigned depth) const
    {
        return tree.find(keyOf(p), depth);
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
        filled.add(p);
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

TEST(StatisticsTree, ManyPointsAtOnceAreTheSameAsOneAfterTheOther)
{
    FilledTree one_by_one, at_once, in_parallel;
    Random random(4);
    for (int scan = 0; scan < 3; scan++)
    {
        std::vector<Eigen::Vector3d> points;
        for (int i = 0; i < 3000; i++) points.push_back(random.vector(2));
        for (const Eigen::Vector3d& p : points) one_by_one.add(p);
        at_once.add(points);
        in_parallel.add(points, 3);
    }
    EXPECT_EQ(at_once.tree.size(), one_by_one.tree.size());
    EXPECT_EQ(at_once.tree.size(), at_once.tree.calcNumNodes());
    EXPECT_EQ(in_parallel.tree.size(), at_once.tree.size());
    for (auto it = one_by_one.tree.begin_tree(), end = one_by_one.tree.end_tree(); it != end; ++it)
    {
        const StatisticsNode* same = at_once.tree.find(it.getKey(), it.getDepth());
        ASSERT_TRUE(same);
        ASSERT_TRUE(in_parallel.tree.find(it.getKey(), it.getDepth()));
        EXPECT_EQ(
            in_parallel.tree.find(it.getKey(), it.getDepth())->statistics(), same->statistics());
        EXPECT_EQ(same->statistics().count, it->statistics().count);
        EXPECT_LT((same->statistics().moments - it->statistics().moments).norm(), 1e-9);
    }
}

TEST(StatisticsTree, AWayLeadsBackToItsLeaf)
{
    for (unsigned i = 0; i < 0x10000; i += 257)
    {
        const octomap::OcTreeKey key(
            static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(0xffff - i),
            static_cast<std::uint16_t>(i * 31));
        EXPECT_EQ(StatisticsTree::keyOf(StatisticsTree::mortonOf(key)), key);
    }
}

TEST(StatisticsTree, ASearchGoesOnWhereTheLastOneEnded)
{
    FilledTree filled;
    const Eigen::Vector3d p(0.55, 0.55, 0.55);
    StatisticsTree::Place place;
    const auto find = [&]
    {
        const octomap::OcTreeKey key = filled.keyOf(p);
        filled.tree.approach(&key, 1, kDepth, &place);
        return place.depth == kDepth ? place.node : nullptr;
    };
    EXPECT_EQ(find(), nullptr);  // the tree is empty
    filled.add(p + Eigen::Vector3d(-0.4, 0, 0));
    EXPECT_EQ(find(), nullptr);
    EXPECT_GE(place.depth, 12u);  // the way to a neighbour is there
    filled.add(p);
    ASSERT_TRUE(find());
    EXPECT_EQ(find(), filled.find(p, kDepth));
    EXPECT_EQ(find()->statistics().count, 1);
}

TEST(StatisticsTree, ManyNodesApproachedTogetherAreTheSameAsOneAfterTheOther)
{
    FilledTree filled;
    Random random(6);
    for (int i = 0; i < 200; i++) filled.add(random.vector(1));
    for (int round = 0; round < 50; round++)
    {
        std::array<octomap::OcTreeKey, 32> keys;
        std::array<StatisticsTree::Place, 32> places;
        for (octomap::OcTreeKey& key : keys) key = filled.keyOf(random.vector(1));
        const unsigned depth = kDepth - static_cast<unsigned>(round) % 5;
        filled.tree.approach(keys.data(), 32, depth, places.data());
        int found = 0;
        for (std::size_t i = 0; i < keys.size(); i++)
        {
            const StatisticsNode* node = filled.tree.search(keys[i], depth);  // octomap's own
            found += node != nullptr;
            EXPECT_EQ(places[i].depth == depth ? places[i].node : nullptr, node);
        }
        if (depth == kDepth - 4)
        {
            EXPECT_GT(found, 0);
        }
    }
}

TEST(StatisticsTree, TellsWhichNodesAreDense)
{
    FilledTree filled;
    Random random(8);
    const Eigen::Vector3d here(1, 1, 1), there(-20, 10, 5);
    const unsigned depth = kDepth - 2;
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 300; i++) points.push_back(here + random.vector(0.02));
    for (int i = 0; i < 300; i++) points.push_back(there + random.vector(2));
    for (int round = 0; round < 2; round++)
    {
        std::vector<const StatisticsNode*> dense;
        for (const std::uint64_t morton : filled.add(points, 2, {depth, 100}))
            dense.push_back(filled.tree.find(StatisticsTree::keyOf(morton), depth));
        for (const auto& p : points)
        {
            const StatisticsNode* node = filled.find(p, depth);
            const auto told = std::count(dense.begin(), dense.end(), node);
            EXPECT_EQ(told, node->statistics().count >= 100 ? 1 : 0);
        }
        EXPECT_GT(dense.size(), 0u);
    }
}

TEST(PointStatistics, AWeightCountsAPointSeveralTimes)
{
    Random random(9);
    PointStatistics weighted, repeated;
    for (int i = 0; i < 20; i++)
    {
        const Eigen::Vector3d p = random.vector(2), view = random.vector(1).normalized();
        weighted.add(p, view, 4);
        for (int k = 0; k < 4; k++) repeated.add(p, view);
    }
    EXPECT_EQ(weighted.count, repeated.count);
    EXPECT_LT((weighted.mean() - repeated.mean()).norm(), 1e-12);
    EXPECT_LT((weighted.scatter() - repeated.scatter()).norm(), 1e-9);
    EXPECT_LT((weighted.views - repeated.views).norm(), 1e-12);
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
    filled.add(p);
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
