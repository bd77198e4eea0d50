#include "taut/map/StatisticsTree.h"

#include <algorithm>

namespace taut
{
void PointStatistics::add(const Eigen::Vector3d& p, const Eigen::Vector3d& view, double weight)
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

void PointStatistics::add(const PointStatistics& other)
{
    count += other.count;
    sum += other.sum;
    moments += other.moments;
    views += other.views;
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

namespace
{
/** Two zero bits before each bit. */
std::uint64_t spread(std::uint64_t bits)
{
    bits = (bits | bits << 32) & 0x001f00000000ffff;
    bits = (bits | bits << 16) & 0x001f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}
}  // namespace

std::uint64_t StatisticsTree::wayTo(const octomap::OcTreeKey& key)
{
    return spread(key[0]) | spread(key[1]) << 1 | spread(key[2]) << 2;
}

StatisticsNode& StatisticsNode::makeChild(unsigned i, bool& is_new)
{
    if (children == nullptr) allocChildren();
    is_new = children[i] == nullptr;
    if (is_new) children[i] = new StatisticsNode();
    return *static_cast<StatisticsNode*>(children[i]);
}

void StatisticsTree::remove(const octomap::OcTreeKey& key, unsigned depth)
{
    const StatisticsNode* node = find(key, depth);
    if (node == nullptr) return;
    tree_size -= node->subtreeSize() - 1;  // octomap counts the node and its ancestors only
    deleteNode(key, depth);
    if (!nodeHasChildren(root)) clear();
}

void StatisticsTree::approach(
    const octomap::OcTreeKey* keys, unsigned count, unsigned depth, Place* places) const
{
    if (root == nullptr) return;
    std::uint32_t on_the_way = 0;
    for (unsigned i = 0; i < count; i++)
    {
        if (places[i].node == nullptr) places[i] = {root, 0};
        if (places[i].depth < depth) on_the_way |= 1u << i;
    }
    while (on_the_way != 0)
        for (unsigned i = 0; i < count; i++)
        {
            if ((on_the_way & 1u << i) == 0) continue;
            Place& place = places[i];
            const unsigned child =
                octomap::computeChildIdx(keys[i], static_cast<int>(tree_depth - place.depth - 1));
            const bool exists = nodeChildExists(place.node, child);
            if (exists)
            {
                place = {getNodeChild(place.node, child), place.depth + 1};
                place.node->prefetch();
            }
            if (!exists || place.depth == depth) on_the_way &= ~(1u << i);
        }
}

const StatisticsNode* StatisticsTree::find(const octomap::OcTreeKey& key, unsigned depth) const
{
    Place place;
    approach(&key, 1, depth, &place);
    return place.depth == depth ? place.node : nullptr;
}

const StatisticsTree::Entry* StatisticsTree::childEnd(
    const Entry* begin, const Entry* end, unsigned depth) const
{
    const unsigned child = childOf(*begin, depth);
    return std::find_if(begin, end, [&](const Entry& e) { return childOf(e, depth) != child; });
}

void StatisticsTree::sort(Entries& entries, Executor& executor)
{
    const auto before = [](const Entry& a, const Entry& b)
    { return a.way != b.way ? a.way < b.way : a.index < b.index; };
    const std::size_t half = (entries.size() + 1) / 2;
    const auto at = [&](std::size_t i) { return entries.begin() + static_cast<std::ptrdiff_t>(i); };
    executor.forChunks(
        entries.size(), half,
        [&](std::size_t, std::size_t begin, std::size_t end)
        { std::sort(at(begin), at(end), before); });
    std::inplace_merge(entries.begin(), at(half), entries.end(), before);
}

std::vector<StatisticsTree::Subtree> StatisticsTree::subtreesOf(
    const Entries& entries, unsigned depth)
{
    if (root == nullptr)
    {
        root = new StatisticsNode();
        tree_size++;
    }
    std::vector<Subtree> level{{root, entries.data(), entries.data() + entries.size(), 0, {}}};
    for (unsigned d = 0; d < depth; d++)
    {
        std::vector<Subtree> next;
        for (const Subtree& s : level)
            for (const Entry* e = s.begin; e != s.end;)
            {
                const Entry* end = childEnd(e, s.end, d);
                bool is_new = false;
                next.push_back({&s.node->makeChild(childOf(*e, d), is_new), e, end, 0, {}});
                tree_size += is_new;
                e = end;
            }
        level = std::move(next);
    }
    return level;
}
}  // namespace taut
