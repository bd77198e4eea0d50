#include "taut/map/StatisticsTree.h"

#include <algorithm>

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

StatisticsNode::StatisticsNode(const StatisticsNode& other)
    : octomap::OcTreeDataNode<PointStatistics>(other.value)
{
    if (other.children == nullptr) return;
    allocChildren();
    for (int i = 0; i < 8; i++)
        if (other.children[i] != nullptr)
            children[i] =
                new StatisticsNode(*static_cast<const StatisticsNode*>(other.children[i]));
}

StatisticsNode::~StatisticsNode()
{
    if (children == nullptr) return;
    for (int i = 0; i < 8; i++) delete static_cast<StatisticsNode*>(children[i]);
    delete[] children;
    children = nullptr;
}

std::size_t StatisticsNode::subtreeSize() const
{
    std::size_t size = 1;
    if (children != nullptr)
        for (int i = 0; i < 8; i++)
            if (children[i] != nullptr)
                size += static_cast<const StatisticsNode*>(children[i])->subtreeSize();
    return size;
}

void StatisticsTree::remove(const octomap::OcTreeKey& key, unsigned depth)
{
    const StatisticsNode* node = Cursor(*this).find(key, depth);
    if (node == nullptr) return;
    tree_size -= node->subtreeSize() - 1;  // octomap counts the node and its ancestors only
    deleteNode(key, depth);
    if (!nodeHasChildren(root)) clear();
}

unsigned StatisticsTree::Cursor::sharedDepth(const octomap::OcTreeKey& key) const
{
    const unsigned differing = static_cast<unsigned>(key[0] ^ key_[0]) |
                               static_cast<unsigned>(key[1] ^ key_[1]) |
                               static_cast<unsigned>(key[2] ^ key_[2]);
    const int used_bits = differing == 0 ? 0 : 32 - __builtin_clz(differing);
    return tree_.tree_depth - static_cast<unsigned>(used_bits);
}

const StatisticsNode* StatisticsTree::Cursor::find(const octomap::OcTreeKey& key, unsigned depth)
{
    if (tree_.root == nullptr) return nullptr;
    way_[0] = tree_.root;
    depth_ = std::min(depth_, sharedDepth(key));
    key_ = key;
    while (depth_ < depth)
    {
        const unsigned child =
            octomap::computeChildIdx(key, static_cast<int>(tree_.tree_depth - depth_ - 1));
        if (!tree_.nodeChildExists(way_[depth_], child)) return nullptr;
        way_[depth_ + 1] = tree_.getNodeChild(way_[depth_], child);
        depth_++;
    }
    return way_[depth];
}

bool StatisticsTree::add(
    Cursor& cursor, const octomap::OcTreeKey& key, const PointStatistics& statistics,
    unsigned from_depth, double capacity)
{
    if (root == nullptr)
    {
        root = new StatisticsNode();
        tree_size++;
    }
    const StatisticsNode* leaf = cursor.find(key, tree_depth);
    if (leaf != nullptr && leaf->statistics().count >= capacity) return false;
    for (; cursor.depth_ < tree_depth; cursor.depth_++)
    {
        const unsigned child =
            octomap::computeChildIdx(key, static_cast<int>(tree_depth - cursor.depth_ - 1));
        cursor.way_[cursor.depth_ + 1] = createNodeChild(cursor.way_[cursor.depth_], child);
    }
    for (unsigned d = from_depth; d <= tree_depth; d++)
        cursor.way_[d]->statistics().add(statistics);
    size_changed = true;
    return true;
}
}  // namespace taut
