#pragma once

#include <octomap/OcTreeBase.h>
#include <octomap/OcTreeDataNode.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "taut/core/Parallel.h"

namespace taut
{
/** Count, sum and second moments of points: enough for their mean and scatter. Sums over disjoint
 * sets add up, so that an inner node is the sum of its children. World frame, double precision: at
 * 10 km from the origin a thickness is still exact to a tenth of a millimetre. */
struct PointStatistics
{
    double count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 6, 1> moments = Eigen::Matrix<double, 6, 1>::Zero();  // xx xy xz yy yz zz
    Eigen::Vector3d views = Eigen::Vector3d::Zero();  //!< sum of the unit vectors to the sensor

    void add(
        const Eigen::Vector3d& p, const Eigen::Vector3d& view = Eigen::Vector3d::Zero(),
        double weight = 1)
    {
        const Eigen::Vector3d wp = weight * p;
        count += weight;
        views += weight * view;
        sum += wp;
        moments[0] += wp.x() * p.x();
        moments[1] += wp.x() * p.y();
        moments[2] += wp.x() * p.z();
        moments[3] += wp.y() * p.y();
        moments[4] += wp.y() * p.z();
        moments[5] += wp.z() * p.z();
    }
    void add(const PointStatistics& other)
    {
        count += other.count;
        sum += other.sum;
        moments += other.moments;
        views += other.views;
    }
    Eigen::Vector3d mean() const { return sum / count; }
    /** Sum of (p - mean)(p - mean)^T. */
    Eigen::Matrix3d scatter() const;

    bool operator==(const PointStatistics& o) const
    {
        return count == o.count && sum == o.sum && moments == o.moments && views == o.views;
    }
};

/** OctoMap node that holds point statistics, at every scale of the tree. */
class StatisticsNode : public octomap::OcTreeDataNode<PointStatistics>
{
 public:
    StatisticsNode() = default;
    StatisticsNode(const StatisticsNode& other);  //!< copies the whole subtree
    StatisticsNode& operator=(const StatisticsNode&) = delete;
    /** Deletes the children too, which octomap leaves behind when it deletes an inner node. */
    ~StatisticsNode();

    /** Number of nodes from this one down. */
    std::size_t subtreeSize() const;

    /** The child, made if it is not there. The tree must be told of new nodes. */
    StatisticsNode& makeChild(unsigned i, bool& is_new)
    {
        if (children == nullptr) allocChildren();
        is_new = children[i] == nullptr;
        if (is_new) children[i] = new StatisticsNode();
        return *static_cast<StatisticsNode*>(children[i]);
    }

    /** Have the memory of the node, or of what leads to its children, at hand when it is needed. */
    void prefetch() const
    {
        __builtin_prefetch(this);
        __builtin_prefetch(reinterpret_cast<const char*>(this + 1) - 1);
    }
    void prefetchChildren() const
    {
        // As a number: where there are no children, a pointer could not be moved.
        const auto first = reinterpret_cast<std::uintptr_t>(children);
        __builtin_prefetch(children);
        __builtin_prefetch(reinterpret_cast<const char*>(first + 7 * sizeof(*children)));
    }

    PointStatistics& statistics() { return value; }
    const PointStatistics& statistics() const { return value; }

    /** Called by octomap when a child is deleted. Nothing to do: forgetting works on blocks that
     * are at least as large as the largest nodes with statistics. */
    void updateOccupancyChildren() {}
};

/** OctoMap tree of point statistics. Nodes are never merged: equal children are not redundant here.
 */
class StatisticsTree : public octomap::OcTreeBase<StatisticsNode>
{
 public:
    static constexpr unsigned kDepth = 16;  //!< of the leaves, in every octomap tree

    explicit StatisticsTree(double leaf_size) : octomap::OcTreeBase<StatisticsNode>(leaf_size) {}
    bool isNodeCollapsible(const StatisticsNode*) const override { return false; }
    bool pruneNode(StatisticsNode*) override { return false; }

    /** How far the way to a node exists: where the next search for it goes on. Valid until nodes
     * are removed from the tree. */
    struct Place
    {
        const StatisticsNode* node =
            nullptr;         //!< the deepest that exists; null: not looked for yet
        unsigned depth = 0;  //!< of that node
    };

    /** Goes as far towards the nodes of at most 32 keys at a depth as they exist. All ways at once:
     * each step waits for memory, and these waits overlap. A place belongs to one key and depth;
     * a node that is there is at that depth. */
    void approach(
        const octomap::OcTreeKey* keys, unsigned count, unsigned depth, Place* places) const;

    /** The node of a key at a depth, or null. */
    const StatisticsNode* find(const octomap::OcTreeKey& key, unsigned depth) const;

    /** Deletes the node of a key at a depth with all below it, and ancestors that become empty. */
    void remove(const octomap::OcTreeKey& key, unsigned depth);

    /** Something to be added to a leaf. */
    struct Entry
    {
        std::uint64_t morton = 0;  //!< mortonOf() the leaf
        std::uint32_t index = 0;   //!< of what is to be added
        std::uint32_t weight = 1;  //!< how often
    };
    using Entries = std::vector<Entry>;

    /** The children from the root to a leaf, three bits each (Morton code): leaves in this order
     * are neighbours in the tree. */
    static std::uint64_t mortonOf(const octomap::OcTreeKey& key);
    /** The leaf of a Morton code. */
    static octomap::OcTreeKey keyOf(std::uint64_t morton);

    /** A node at this depth is dense when it holds this many points. */
    struct DenseRule
    {
        unsigned depth = 0;
        double points = 0;
    };

    /** Adds to leaves, and to their ancestors from the given depth down, what `put(entry,
     * statistics)` adds for each entry. Every node is visited once, in the order of the entries'
     * Morton codes: the sums do not depend on threads. Sorts the entries in that order. Gives the
     * code of one entry of each node that it leaves dense. */
    template <class Put>
    std::vector<std::uint64_t> add(
        Entries& entries, unsigned from_depth, const DenseRule& dense_rule, const Put& put,
        Executor& executor);

 private:
    /** A node and the entries on their way through it. */
    struct Branch
    {
        StatisticsNode* node = nullptr;
        const Entry *begin = nullptr, *end = nullptr;
        std::size_t parent = 0;  //!< its place among the branches one depth above
    };
    using Branches = std::vector<Branch>;
    /** What comes of filling some subtrees. */
    struct Filled
    {
        std::size_t created = 0;           //!< nodes
        std::vector<std::uint64_t> dense;  //!< the code of a leaf in each dense node
    };
    /** As far as the ways to several keys are the same. */
    Place approachTogether(const octomap::OcTreeKey* keys, unsigned count, unsigned depth) const;
    void sort(Entries& entries);
    Branches branchesOf(const Entries& entries, unsigned depth);
    static std::size_t split(const Branches& branches, unsigned depth, Branches& below);
    template <class Put>
    static Filled fill(
        Branches subtrees, unsigned depth, const DenseRule& dense_rule, const Put& put);
    static const Entry* childEnd(const Entry* begin, const Entry* end, unsigned depth);
    static unsigned childOf(const Entry& entry, unsigned depth)
    {
        return static_cast<unsigned>(entry.morton >> 3 * (kDepth - depth - 1) & 7);
    }

    Entries sorted_;  // while sorting; kept, since fresh memory is slow
};

template <class Put>
std::vector<std::uint64_t> StatisticsTree::add(
    Entries& entries, unsigned from_depth, const DenseRule& dense_rule, const Put& put,
    Executor& executor)
{
    if (entries.empty()) return {};
    sort(entries);
    const Branches subtrees = branchesOf(entries, from_depth);
    constexpr std::size_t kChunk = 8;
    std::vector<Filled> filled(Executor::chunks(subtrees.size(), kChunk));
    executor.forChunks(
        subtrees.size(), kChunk,
        [&](std::size_t chunk, std::size_t begin, std::size_t end)
        {
            filled[chunk] = fill(
                Branches(subtrees.data() + begin, subtrees.data() + end), from_depth, dense_rule,
                put);
        });
    std::vector<std::uint64_t> dense;
    for (const Filled& f : filled)
    {
        tree_size += f.created;
        dense.insert(dense.end(), f.dense.begin(), f.dense.end());
    }
    size_changed = true;
    return dense;
}

template <class Put>
StatisticsTree::Filled StatisticsTree::fill(
    Branches subtrees, unsigned depth, const DenseRule& dense_rule, const Put& put)
{
    // Depth by depth, not branch by branch: each node waits for memory, and these waits overlap.
    Filled filled;
    std::array<Branches, kDepth + 1> at;
    at[depth] = std::move(subtrees);
    for (unsigned d = depth; d < kDepth; d++) filled.created += split(at[d], d, at[d + 1]);
    std::vector<PointStatistics> added(at[kDepth].size()), above;
    for (std::size_t i = 0; i < added.size(); i++)
        for (const Entry* e = at[kDepth][i].begin; e != at[kDepth][i].end; ++e) put(*e, added[i]);
    for (unsigned d = kDepth;; d--)
    {
        if (d > depth) above.assign(at[d - 1].size(), {});
        for (std::size_t i = 0; i < added.size(); i++)
        {
            const Branch& b = at[d][i];
            b.node->statistics().add(added[i]);
            if (d > depth) above[b.parent].add(added[i]);
            if (d == dense_rule.depth && b.node->statistics().count >= dense_rule.points)
                filled.dense.push_back(b.begin->morton);
        }
        if (d == depth) return filled;
        added.swap(above);
    }
}
}  // namespace taut
