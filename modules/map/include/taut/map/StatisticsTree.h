#pragma once

#include <octomap/OcTreeBase.h>
#include <octomap/OcTreeDataNode.h>

#include <Eigen/Core>
#include <array>

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

    void add(const Eigen::Vector3d& p);
    void add(const PointStatistics& other);
    Eigen::Vector3d mean() const { return sum / count; }
    /** Sum of (p - mean)(p - mean)^T. */
    Eigen::Matrix3d scatter() const;

    bool operator==(const PointStatistics& o) const
    {
        return count == o.count && sum == o.sum && moments == o.moments;
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

    /** The way from the root to the node looked up last. Near keys share most of their way: the
     * next look-up starts where both part. Valid until the tree is changed by others. */
    class Cursor
    {
     public:
        explicit Cursor(const StatisticsTree& tree) : tree_(tree) {}
        /** The node of a key at a depth, or null. */
        const StatisticsNode* find(const octomap::OcTreeKey& key, unsigned depth);

     private:
        friend class StatisticsTree;
        unsigned sharedDepth(const octomap::OcTreeKey& key) const;

        const StatisticsTree& tree_;
        std::array<StatisticsNode*, 17> way_{};
        octomap::OcTreeKey key_;
        unsigned depth_ = 0;  // of the last node of the way that exists
    };

    /** Deletes the node of a key at a depth with all below it, and ancestors that become empty. */
    void remove(const octomap::OcTreeKey& key, unsigned depth);

    /** Adds statistics to the leaf of a key and to its ancestors from the given depth down, unless
     * the leaf holds `capacity` points already. False if it does. */
    bool add(
        Cursor& cursor, const octomap::OcTreeKey& key, const PointStatistics& statistics,
        unsigned from_depth, double capacity);
};
}  // namespace taut
