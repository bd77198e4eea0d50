#include "taut/map/StatisticsTree.h"

#include <algorithm>
#include <numeric>

namespace taut
{
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

/** Takes the zero bits out again. */
std::uint16_t gather(std::uint64_t bits)
{
    bits &= 0x1249249249249249;
    bits = (bits | bits >> 2) & 0x10c30c30c30c30c3;
    bits = (bits | bits >> 4) & 0x100f00f00f00f00f;
    bits = (bits | bits >> 8) & 0x001f0000ff0000ff;
    bits = (bits | bits >> 16) & 0x001f00000000ffff;
    return static_cast<std::uint16_t>(bits | bits >> 32);
}
}  // namespace

std::uint64_t StatisticsTree::mortonOf(const octomap::OcTreeKey& key)
{
    return spread(key[0]) | spread(key[1]) << 1 | spread(key[2]) << 2;
}

octomap::OcTreeKey StatisticsTree::keyOf(std::uint64_t morton)
{
    return {gather(morton), gather(morton >> 1), gather(morton >> 2)};
}

void StatisticsTree::remove(const octomap::OcTreeKey& key, unsigned depth)
{
    const StatisticsNode* node = find(key, depth);
    if (node == nullptr) return;
    tree_size -= node->subtreeSize() - 1;  // octomap counts the node and its ancestors only
    deleteNode(key, depth);
    if (!nodeHasChildren(root)) clear();
}

StatisticsTree::Place StatisticsTree::approachTogether(
    const octomap::OcTreeKey* keys, unsigned count, unsigned depth) const
{
    unsigned differing = 0;
    for (unsigned i = 1; i < count; i++)
        for (unsigned k = 0; k < 3; k++) differing |= keys[i][k] ^ keys[0][k];
    Place place{root, 0};
    for (; place.depth < depth && differing >> (kDepth - place.depth - 1) == 0; place.depth++)
    {
        const unsigned child =
            octomap::computeChildIdx(keys[0], static_cast<int>(kDepth - place.depth - 1));
        if (!nodeChildExists(place.node, child)) break;
        place.node = getNodeChild(place.node, child);
    }
    return place;
}

void StatisticsTree::approach(
    const octomap::OcTreeKey* keys, unsigned count, unsigned depth, Place* places) const
{
    if (root == nullptr) return;
    if (std::any_of(places, places + count, [](const Place& p) { return p.node == nullptr; }))
    {
        const Place shared = approachTogether(keys, count, depth);
        for (unsigned i = 0; i < count; i++)
            if (places[i].node == nullptr) places[i] = shared;
    }
    std::uint32_t on_the_way = 0;
    for (unsigned i = 0; i < count; i++)
        if (places[i].depth < depth) on_the_way |= 1u << i;
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
    const Entry* begin, const Entry* end, unsigned depth)
{
    const unsigned child = childOf(*begin, depth);
    return std::find_if(begin, end, [&](const Entry& e) { return childOf(e, depth) != child; });
}

void StatisticsTree::sort(Entries& entries)
{
    // By one byte of the ways after the other, from the lowest: each time the order within equal
    // bytes stays. Few bytes differ, and for thousands of entries this is faster than comparing.
    std::uint64_t differing = 0;
    for (const Entry& e : entries) differing |= e.morton ^ entries.front().morton;
    sorted_.resize(entries.size());
    for (unsigned shift = 0; shift < 64; shift += 8)
    {
        if ((differing >> shift & 0xff) == 0) continue;
        std::array<std::uint32_t, 257> begin{};
        for (const Entry& e : entries) begin[(e.morton >> shift & 0xff) + 1]++;
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        for (const Entry& e : entries) sorted_[begin[e.morton >> shift & 0xff]++] = e;
        entries.swap(sorted_);
    }
}

std::size_t StatisticsTree::split(const Branches& branches, unsigned depth, Branches& below)
{
    std::size_t created = 0;
    below.clear();
    below.reserve(branches.size());
    for (const Branch& b : branches) b.node->prefetchChildren();
    for (std::size_t i = 0; i < branches.size(); i++)
    {
        const Branch& b = branches[i];
        for (const Entry* e = b.begin; e != b.end;)
        {
            const Entry* end = childEnd(e, b.end, depth);
            bool is_new = false;
            StatisticsNode& child = b.node->makeChild(childOf(*e, depth), is_new);
            child.prefetch();
            created += is_new;
            below.push_back({&child, e, end, i});
            e = end;
        }
    }
    return created;
}

StatisticsTree::Branches StatisticsTree::branchesOf(const Entries& entries, unsigned depth)
{
    if (root == nullptr)
    {
        root = new StatisticsNode();
        tree_size++;
    }
    Branches branches{{root, entries.data(), entries.data() + entries.size()}}, below;
    for (unsigned d = 0; d < depth; d++)
    {
        tree_size += split(branches, d, below);
        branches.swap(below);
    }
    return branches;
}
}  // namespace taut
