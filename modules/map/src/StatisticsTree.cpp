#include "taut/map/StatisticsTree.h"

namespace taut
{
void PointStatistics::add(const Eigen::Vector3d& p)
{
    count += 1;
    sum += p;
    moments[0] += p.x() * p.x();
    moments[1] += p.x() * p.y();
    moments[2] += p.x() * p.z();
    moments[3] += p.y() * p.y();
    moments[4] += p.y() * p.z();
    moments[5] += p.z() * p.z();
}

void PointStatistics::add(const PointStatistics& other)
{
    count += other.count;
    sum += other.sum;
    moments += other.moments;
}

Eigen::Matrix3d PointStatistics::scatter() const
{
    Eigen::Matrix3d m;
    m << moments[0], moments[1], moments[2], moments[1], moments[3], moments[4], moments[2],
        moments[4], moments[5];
    return m - sum * sum.transpose() / count;
}

void StatisticsTree::add(
    const octomap::OcTreeKey& key, const PointStatistics& statistics, unsigned from_depth)
{
    if (root == nullptr)
    {
        root = new StatisticsNode();
        tree_size++;
    }
    StatisticsNode* node = root;
    for (unsigned depth = 1; depth <= tree_depth; depth++)
    {
        const unsigned child = octomap::computeChildIdx(key, static_cast<int>(tree_depth - depth));
        node =
            nodeChildExists(node, child) ? getNodeChild(node, child) : createNodeChild(node, child);
        if (depth >= from_depth) node->statistics().add(statistics);
    }
    size_changed = true;
}

const StatisticsNode* StatisticsTree::find(const octomap::OcTreeKey& key, unsigned depth) const
{
    const StatisticsNode* node = root;
    for (unsigned d = 1; node != nullptr && d <= depth; d++)
    {
        const unsigned child = octomap::computeChildIdx(key, static_cast<int>(tree_depth - d));
        node = nodeChildExists(node, child) ? getNodeChild(node, child) : nullptr;
    }
    return node;
}
}  // namespace taut
