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
        double weight = 1);
    void add(const PointStatistics& other);
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
    StatisticsNode& makeChild(unsigned i, bool& is_new);

    /** Have the memory of the node, or of what leads to its children, at hand when it is needed. */
    void prefetch() const
    {
        __builtin_prefetch(this);
        __builtin_prefetch(reinterpret_cast<const char*>(this + 1) - 1);
    }
    void prefetchChildren() const { __builtin_prefetch(children); }

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
        std::uint64_t way = 0;    //!< wayTo() the leaf
        std::uint32_t index = 0;  //!< of what is to be added
    };
    using Entries = std::vector<Entry>;

    /** The children from the root to a leaf, three bits each (Morton code): leaves in this order
     * are neighbours in the tree. */
    static std::uint64_t wayTo(const octomap::OcTreeKey& key);

    /** A node at this depth is ripe when it holds this many points. */
    struct Ripeness
    {
        unsigned depth = 0;
        double points = 0;
    };

    /** Adds to leaves, and to their ancestors from the given depth down, what `put(index,
     * statistics)` adds for each entry. Every node is visited once, in the order of the entries'
     * ways: the sums do not depend on threads. Gives the index of an entry of each node that it
     * leaves ripe. */
    template <class Put>
    std::vector<std::uint32_t> add(
        Entries entries, unsigned from_depth, const Ripeness& ripeness, const Put& put,
        Executor& executor);

 private:
    /** A subtree whose nodes have statistics, and the entries that belong to it. */
    struct Subtree
    {
        StatisticsNode* node = nullptr;
        const Entry *begin = nullptr, *end = nullptr;
        std::size_t created = 0;          //!< nodes
        std::vector<std::uint32_t> ripe;  //!< an index of each ripe node
    };
    static void sort(Entries& entries, Executor& executor);
    std::vector<Subtree> subtreesOf(const Entries& entries, unsigned depth);
    template <class Put>
    PointStatistics fill(
        StatisticsNode& node, unsigned depth, const Entry* begin, const Entry* end,
        const Ripeness& ripeness, const Put& put, Subtree& whole);
    const Entry* childEnd(const Entry* begin, const Entry* end, unsigned depth) const;
    unsigned childOf(const Entry& entry, unsigned depth) const
    {
        return static_cast<unsigned>(entry.way >> 3 * (tree_depth - depth - 1) & 7);
    }
};

template <class Put>
std::vector<std::uint32_t> StatisticsTree::add(
    Entries entries, unsigned from_depth, const Ripeness& ripeness, const Put& put,
    Executor& executor)
{
    if (entries.empty()) return {};
    sort(entries, executor);
    std::vector<Subtree> subtrees = subtreesOf(entries, from_depth);
    executor.forChunks(
        subtrees.size(), 8,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
            {
                Subtree& s = subtrees[i];
                fill(*s.node, from_depth, s.begin, s.end, ripeness, put, s);
            }
        });
    std::vector<std::uint32_t> ripe;
    for (const Subtree& s : subtrees)
    {
        tree_size += s.created;
        ripe.insert(ripe.end(), s.ripe.begin(), s.ripe.end());
    }
    size_changed = true;
    return ripe;
}

template <class Put>
PointStatistics StatisticsTree::fill(
    StatisticsNode& node, unsigned depth, const Entry* begin, const Entry* end,
    const Ripeness& ripeness, const Put& put, Subtree& whole)
{
    const std::uint32_t first = begin->index;
    PointStatistics added;
    if (depth == tree_depth)
    {
        for (const Entry* e = begin; e != end; ++e) put(e->index, added);
    }
    else
    {
        struct Branch
        {
            StatisticsNode* node;
            const Entry *begin, *end;
        };
        std::array<Branch, 8> below;
        std::size_t children = 0;
        while (begin != end)
        {
            const Entry* next = childEnd(begin, end, depth);
            bool is_new = false;
            StatisticsNode& child = node.makeChild(childOf(*begin, depth), is_new);
            child.prefetch();
            whole.created += is_new;
            below[children++] = {&child, begin, next};
            begin = next;
        }
        for (std::size_t i = 0; i < children; i++)
        {
            if (i + 1 < children) below[i + 1].node->prefetchChildren();
            const Branch& b = below[i];
            added.add(fill(*b.node, depth + 1, b.begin, b.end, ripeness, put, whole));
        }
    }
    node.statistics().add(added);
    if (depth == ripeness.depth && node.statistics().count >= ripeness.points)
        whole.ripe.push_back(first);
    return added;
}
}  // namespace taut
