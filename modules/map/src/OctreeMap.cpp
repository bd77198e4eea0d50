#include "taut/map/OctreeMap.h"

#include <algorithm>
#include <cmath>

#include "packedKey.h"

IMPLEMENTS_MRPT_OBJECT(OctreeMap, taut::Map, taut)

namespace taut
{
namespace
{
constexpr double kBlockSize = 8.0;    // [m] about: unit of forgetting
constexpr int kRecenterKeys = 16384;  // leaves from the origin: half of what keys can name

constexpr int kDenseLevel = 2;       // of the nodes that are judged: 4 leaves a side
constexpr unsigned kDenseShare = 4;  // one point in so many

/** The node of that level that holds a leaf. */
std::uint64_t denseKey(const octomap::OcTreeKey& leaf)
{
    return packVoxel(leaf[0] >> kDenseLevel, leaf[1] >> kDenseLevel, leaf[2] >> kDenseLevel);
}
}  // namespace

OctreeMap::OctreeMap()
{
    clear();
}

OctreeMap::OctreeMap(const OctreeMap& other)
    : Map(other),
      config(other.config),
      tree_(std::make_unique<StatisticsTree>(*other.tree_)),
      levels_(other.levels_),
      range_noise_(other.range_noise_),
      insertions_(other.insertions_),
      state_(std::make_shared<const char>()),
      dense_(other.dense_),
      blocks_(other.blocks_),
      last_center_(other.last_center_),
      origin_(other.origin_)
{
}

void OctreeMap::configure(ConfigSection& s)
{
    s.key("leaf_size", config.leaf_size, {0.01, 10}, "m, edge of the smallest node");
    s.key("scales", config.scales, {1, 8}, "number of window sizes, doubling from 2 leaf_size");
    s.key("min_points", config.min_points, {4, 1e6}, "fewest points of a window that is believed");
    s.key(
        "scale_tolerance", config.scale_tolerance, {1, 100},
        "factor by which a larger window may be thicker than the thinnest one");
    s.key("max_thickness", config.max_thickness, kPositive, "m, thicker windows are no planes");
    s.key("max_flatness", config.max_flatness, {0, 1}, "ratio of thickness to the extent");
    s.key("min_width", config.min_width, kPositive, "m, narrower windows have no known normal");
    s.key(
        "min_cosine", config.min_cosine, {0, 1},
        "of the angle between a surface's normal and the views of it: else it is seen edge-on");
    s.key(
        "min_spread", config.min_spread, kNotNegative,
        "the same as a share of the window's half edge");
    s.key("gate", config.gate, kPositive, "m, largest distance to the surface");
    s.key("min_sigma", config.min_sigma, kPositive, "m, no surface is believed to be thinner");
    s.key(
        "dense_points", config.dense_points, kPositive,
        "in a node of 4 leaf_size: from then on it takes one point in four, with that weight");
    s.key("lines", config.lines, "match thin, long windows as lines");
    s.key(
        "window_radius", config.window_radius, kPositive, "m, half edge of the cube that is kept");
    clear();
}

void OctreeMap::clear()
{
    tree_ = std::make_unique<StatisticsTree>(config.leaf_size);
    levels_ = std::vector<Level>(static_cast<std::size_t>(config.scales));
    blocks_.clear();
    insertions_ = 0;
    range_noise_ = 0;
    dense_.clear();
    last_center_.setConstant(1e300);
    origin_.setZero();
    changed();
}

unsigned OctreeMap::blockDepth() const
{
    const int up = static_cast<int>(std::lround(std::log2(kBlockSize / config.leaf_size)));
    return StatisticsTree::kDepth - static_cast<unsigned>(std::clamp(up, config.scales - 1, 15));
}

void OctreeMap::insert(const std::vector<MapPoint>& points, Executor& executor)
{
    entries_.resize(points.size());
    executor.forChunks(
        points.size(), 1024,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
                entries_[i] = entryOf(points[i].position, static_cast<std::uint32_t>(i));
        });
    const auto dropped = [](const StatisticsTree::Entry& e) { return e.weight == 0; };
    entries_.erase(std::remove_if(entries_.begin(), entries_.end(), dropped), entries_.end());
    const std::vector<std::uint64_t> dense = tree_->add(
        entries_, depthOf(config.scales - 1), {depthOf(kDenseLevel), config.dense_points},
        [&](const StatisticsTree::Entry& e, PointStatistics& sum)
        { sum.add(points[e.index].position, points[e.index].view, e.weight); },
        executor);
    for (const std::uint64_t morton : dense) dense_.insert(denseKey(StatisticsTree::keyOf(morton)));
    rememberBlocks(entries_);
    insertions_++;
    changed();
    learnRangeNoise(points, executor);
}

bool OctreeMap::leafOf(const Vector3d& p, octomap::OcTreeKey& leaf) const
{
    // As octomap does; its std::floor takes more time than all the rest.
    for (unsigned i = 0; i < 3; i++)
    {
        const double scaled = static_cast<float>(p[i] - origin_[i]) * (1 / config.leaf_size);
        if (!(scaled >= -kMiddleKey && scaled < kMiddleKey)) return false;
        const int towards_zero = static_cast<int>(scaled);
        leaf[i] =
            static_cast<std::uint16_t>(towards_zero - (scaled < towards_zero ? 1 : 0) + kMiddleKey);
    }
    return true;
}

StatisticsTree::Entry OctreeMap::entryOf(const Vector3d& p, std::uint32_t index) const
{
    octomap::OcTreeKey leaf;
    if (!leafOf(p, leaf)) return {0, index, 0};
    return {StatisticsTree::mortonOf(leaf), index, weightOf(leaf, index)};
}

std::uint32_t OctreeMap::weightOf(const octomap::OcTreeKey& leaf, std::uint32_t point) const
{
    if (!dense_.contains(denseKey(leaf))) return 1;
    const std::uint64_t draw = mixBits(std::uint64_t{insertions_} << 32 | point);
    return draw % kDenseShare == 0 ? kDenseShare : 0;
}

void OctreeMap::rememberBlocks(const StatisticsTree::Entries& sorted)
{
    const unsigned above_leaf = StatisticsTree::kDepth - blockDepth();
    std::uint64_t last_block = ~std::uint64_t{0};
    for (const StatisticsTree::Entry& e : sorted)
    {
        const std::uint64_t block = e.morton >> 3 * above_leaf;
        if (block != last_block) remember(StatisticsTree::keyOf(e.morton));
        last_block = block;
    }
}

void OctreeMap::remember(const octomap::OcTreeKey& leaf)
{
    const unsigned shift = StatisticsTree::kDepth - blockDepth();
    blocks_.insert(pack(
        static_cast<std::uint16_t>(leaf[0] >> shift << shift),
        static_cast<std::uint16_t>(leaf[1] >> shift << shift),
        static_cast<std::uint16_t>(leaf[2] >> shift << shift)));
}

void OctreeMap::slide(const Vector3d& center_world)
{
    if ((center_world - last_center_).norm() < kBlockSize) return;
    last_center_ = center_world;
    changed();
    dense_.clear();  // of what may be forgotten; the others tell again
    const double reach = config.window_radius + kBlockSize;
    const auto outside = [&](const octomap::OcTreeKey& key, unsigned depth)
    {
        const octomap::point3d c = tree_->keyToCoord(key, depth);
        const Vector3d d = Vector3d(c.x(), c.y(), c.z()) + origin_ - center_world;
        return d.cwiseAbs().maxCoeff() > reach;
    };
    const std::size_t blocks = blocks_.size();
    for (auto it = blocks_.begin(); it != blocks_.end();)
    {
        const octomap::OcTreeKey key = unpack(*it);
        if (outside(key, blockDepth()))
        {
            tree_->remove(key, blockDepth());
            it = blocks_.erase(it);
        }
        else
        {
            ++it;
        }
    }
    if (blocks_.size() < blocks)
        forgetWindows([&](std::uint64_t corner)
                      { return outside(unpack(corner), StatisticsTree::kDepth); });
    if ((center_world - origin_).cwiseAbs().maxCoeff() > kRecenterKeys * config.leaf_size)
        recenter(center_world);
}

template <class Outside>
void OctreeMap::forgetWindows(const Outside& outside)
{
    for (Level& level : levels_)
        level.index.eraseIf(
            [&](std::uint64_t corner, std::uint32_t window)
            {
                level.windows[window].places = {};  // some nodes are gone
                const bool leaves = outside(corner);
                if (leaves) level.windows.remove(window);
                return leaves;
            });
}

void OctreeMap::recenter(const Vector3d& center_world)
{
    StatisticsTree::Entries entries;
    std::vector<PointStatistics> leaves;
    const double edge = config.leaf_size * (1 << (StatisticsTree::kDepth - blockDepth()));
    std::array<int, 3> shift{};  // of the keys, by whole blocks: every node keeps its content
    for (int i = 0; i < 3; i++)
    {
        const double blocks = std::round((center_world[i] - origin_[i]) / edge);
        // Beyond the keys nothing is left that would have to be moved.
        constexpr double kFurthest = 2 * kMiddleKey;
        shift[static_cast<std::size_t>(i)] = static_cast<int>(std::clamp(
            blocks * (1 << (StatisticsTree::kDepth - blockDepth())), -kFurthest, kFurthest));
        origin_[i] += blocks * edge;
    }
    blocks_.clear();
    const auto end = tree_->end_leafs();
    for (auto it = tree_->begin_leafs(); it != end; ++it)
    {
        const octomap::OcTreeKey old = it.getKey();
        const octomap::OcTreeKey key(
            static_cast<std::uint16_t>(old[0] - shift[0]),
            static_cast<std::uint16_t>(old[1] - shift[1]),
            static_cast<std::uint16_t>(old[2] - shift[2]));
        entries.push_back(
            {StatisticsTree::mortonOf(key), static_cast<std::uint32_t>(leaves.size())});
        leaves.push_back(it->statistics());
    }
    tree_ = std::make_unique<StatisticsTree>(config.leaf_size);
    moveWindows(shift);
    Executor single;
    tree_->add(
        entries, depthOf(config.scales - 1), {},
        [&](const StatisticsTree::Entry& e, PointStatistics& sum) { sum.add(leaves[e.index]); },
        single);
    rememberBlocks(entries);
}

void OctreeMap::moveWindows(const std::array<int, 3>& shift)
{
    for (Level& level : levels_)
    {
        KeyTable moved;
        level.index.forEach(
            [&](std::uint64_t, std::uint32_t number)
            {
                Window& window = level.windows[number];
                for (std::size_t i = 0; i < 3; i++)
                    window.corner[i] = static_cast<std::uint16_t>(window.corner[i] - shift[i]);
                window.places = {};  // the nodes are new
                moved.insert(cornerOf(window), number);
            });
        level.index = std::move(moved);
    }
}
}  // namespace taut
