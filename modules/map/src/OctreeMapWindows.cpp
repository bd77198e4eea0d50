// The windows of OctreeMap: which are kept, and what their points look like.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "packedKey.h"
#include "taut/map/OctreeMap.h"

namespace taut
{
namespace
{
constexpr std::uint8_t kMaxPatience = 15;  // insertions
constexpr std::size_t kWindowChunk = 64;
constexpr double kGrowth = 1.2;  // of a window's points, that it is computed anew
constexpr double kDoubt = 3;     // deviations of the thickness of a smaller window
constexpr double kMargin = 256;  // [leaves] more than half a window
}  // namespace

OctreeMap::Windows::Windows(const Windows& other) : size_(other.size_), free_(other.free_)
{
    for (const auto& block : other.blocks_)
    {
        blocks_.push_back(std::make_unique<Window[]>(kBlock));
        std::copy_n(block.get(), kBlock, blocks_.back().get());
        for (std::uint32_t i = 0; i < kBlock; i++) blocks_.back()[i].places = {};
    }
}

std::uint32_t OctreeMap::Windows::add()
{
    if (!free_.empty())
    {
        const std::uint32_t i = free_.back();
        free_.pop_back();
        return i;
    }
    if (size_ == kBlock * blocks_.size()) blocks_.push_back(std::make_unique<Window[]>(kBlock));
    return size_++;
}

void OctreeMap::Windows::clear()
{
    size_ = 0;
    free_.clear();
}

OctreeMap::Cell OctreeMap::cellOf(const Vector3d& p) const
{
    Cell cell;
    for (int i = 0; i < 3; i++)
    {
        const double halves = 2 * ((p[i] - origin_[i]) / config.leaf_size + kMiddleKey);
        if (!(halves >= 2 * kMargin && halves < 2 * (2 * kMiddleKey - kMargin))) return {};
        cell[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(halves);
    }
    return cell;
}

std::uint64_t OctreeMap::cornerOf(const Cell& cell, int level)
{
    // The key of the node just above the node corner that is nearest to the cell.
    const auto key = [&](std::uint32_t halves)
    { return static_cast<std::uint16_t>((halves + (1u << level)) >> (level + 1) << level); };
    return pack(key(cell[0]), key(cell[1]), key(cell[2]));
}

void OctreeMap::Asked::clear()
{
    index.clear();
    windows.clear();
    kept.clear();
    shown.clear();
}

std::uint32_t OctreeMap::Level::at(std::uint64_t corner)
{
    std::uint32_t number = index.find(corner);
    if (number != kNoWindow) return number;
    number = windows.add();
    index.insert(corner, number);
    const octomap::OcTreeKey key = unpack(corner);
    windows[number] = {};
    windows[number].corner = {key[0], key[1], key[2]};
    return number;
}

void OctreeMap::Level::put(const Window& window)
{
    std::uint32_t number = index.find(cornerOf(window));
    if (number == kNoWindow)
    {
        number = windows.add();
        index.insert(cornerOf(window), number);
    }
    windows[number] = window;
}

void OctreeMap::keep(MapScratch& scratch)
{
    keep(scratch.as<Scratch>());
}

void OctreeMap::keep(Scratch& scratch)
{
    if (scratch.state != state_) return;  // of a map that is no more
    for (std::size_t l = 0; l < levels_.size(); l++)
    {
        Level& level = levels_[l];
        const Asked& asked = scratch.asked[l];
        for (std::uint32_t i = 0; i < asked.kept.size(); i++)
            if (asked.kept[i] != kNoWindow)
                level.windows[asked.kept[i]].prefetchCheck();
            else
                level.index.prefetch(cornerOf(asked.windows[i]));
        for (std::uint32_t i = 0; i < asked.kept.size(); i++)
        {
            const Window& window = asked.windows[i];
            if (asked.kept[i] == kNoWindow)
                level.put(window);
            else if (asked.shown[i] == asked.kept[i])
                level.windows[asked.kept[i]].takeCheck(window);
            else
                level.windows[asked.kept[i]] = window;
        }
    }
    scratch.state.reset();
}

void OctreeMap::refreshAll(
    Windows& windows, const std::vector<std::uint32_t>& stale, int level, Executor& executor) const
{
    // Waking a thread takes as long as some tens of windows do.
    executor.forChunks(
        stale.size(), std::max<std::size_t>(kWindowChunk, (stale.size() + 3) / 4),
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
                for (const StatisticsTree::Place& place : windows[stale[i]].places)
                    if (place.node != nullptr) place.node->prefetch();
            for (std::size_t i = begin; i < end; i++) locate(windows[stale[i]], level);
            for (std::size_t i = begin; i < end; i++) refresh(windows[stale[i]], level);
        });
}

std::uint64_t OctreeMap::cornerOf(const Window& window)
{
    return pack(window.corner[0], window.corner[1], window.corner[2]);
}

bool OctreeMap::isStale(const Window& window) const
{
    return window.checked == 0 || insertions_ - window.checked > window.patience;
}

void OctreeMap::locate(Window& window, int level) const
{
    const auto step = static_cast<std::uint16_t>(1u << level);
    std::array<octomap::OcTreeKey, 8> keys;
    for (unsigned i = 0; i < 8; i++)
        keys[i] = octomap::OcTreeKey(
            static_cast<std::uint16_t>(window.corner[0] - (i & 1 ? step : 0)),
            static_cast<std::uint16_t>(window.corner[1] - (i & 2 ? step : 0)),
            static_cast<std::uint16_t>(window.corner[2] - (i & 4 ? step : 0)));
    tree_->approach(keys.data(), 8, depthOf(level), window.places.data());
}

void OctreeMap::refresh(Window& window, int level) const
{
    const unsigned depth = depthOf(level);
    double count = 0;
    for (const StatisticsTree::Place& place : window.places)
        if (place.depth == depth) count += place.node->statistics().count;
    if (count >= config.min_points && count >= kGrowth * window.count)
    {
        PointStatistics sum;
        for (const StatisticsTree::Place& place : window.places)
            if (place.depth == depth) sum.add(place.node->statistics());
        compute(window, level, sum);
    }
    schedule(window, count);
}

void OctreeMap::schedule(Window& window, double count) const
{
    // Few new points change a surface little: it is kept until a fifth more have come, and not
    // looked at before they are expected.
    const double arrived = count - window.seen;
    const double missing = std::max<double>(config.min_points, kGrowth * window.count) - count;
    window.seen = count;
    window.patience = 0;
    if (window.age == 0) return;
    window.patience = missing * window.age < kMaxPatience * arrived
                          ? static_cast<std::uint8_t>(missing * window.age / arrived)
                          : kMaxPatience;
}

void OctreeMap::compute(Window& window, int level, const PointStatistics& statistics) const
{
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(Eigen::Matrix3d(statistics.scatter() / statistics.count));
    window.count = statistics.count;
    window.mean = statistics.mean();
    window.normal = eigen.eigenvectors().col(0);
    window.axis = eigen.eigenvectors().col(2);
    window.cosine = window.normal.dot(statistics.views / statistics.count);
    // Three degrees of freedom went into the plane.
    const double thickness2 =
        std::max(0.0, eigen.eigenvalues()[0]) * statistics.count / (statistics.count - 3);
    window.width2 = std::max(0.0, eigen.eigenvalues()[1]);
    window.length2 = std::max(0.0, eigen.eigenvalues()[2]);
    window.variance = std::max(thickness2, config.min_sigma * config.min_sigma);
    // The relative deviation of a variance from n - 3 residuals is sqrt(2 / (n - 3)).
    window.largest_variance = window.variance * (1 + kDoubt * std::sqrt(2 / (window.count - 3)));
    // One ring of a LiDAR that has hardly moved lies in the cone of its beam, which looks like a
    // surface where the ring bends or goes around a corner: one that is seen edge-on.
    const double view = (statistics.views / statistics.count).norm();
    window.plane =
        std::abs(window.cosine) >= config.min_cosine * view && isPlane(window, level, thickness2);
    window.line = isLine(window);
}

bool OctreeMap::isPlane(const Window& w, int level, double thickness2) const
{
    const double min_width =
        std::max(config.min_width, config.min_spread * config.leaf_size * (1 << level));
    return thickness2 < config.max_thickness * config.max_thickness &&
           thickness2 < config.max_flatness * config.max_flatness * w.width2 &&
           w.width2 > min_width * min_width;
}

bool OctreeMap::isLine(const Window& w) const
{
    return config.lines && w.width2 < config.max_thickness * config.max_thickness &&
           w.width2 < config.max_flatness * config.max_flatness * w.length2;
}
}  // namespace taut
