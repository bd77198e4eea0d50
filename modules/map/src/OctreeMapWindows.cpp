// How OctreeMap finds the surface of a query: its windows and the search through their sizes.
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
constexpr double kGrowth = 1.2;       // of a window's points, that it is computed anew
constexpr double kDoubt = 3;          // deviations of the thickness of a smaller window
constexpr double kThin = 0.1;         // quantile of the planes that tells the noise
constexpr std::uint32_t kYoung = 30;  // insertions: a young map is as thick as it is wrong
constexpr double kSameView = 1e-3;    // squared, between iterations
constexpr double kGrazing = 0.05;     // cosine to the normal
constexpr double kMargin = 256;       // [leaves] more than half a window
}  // namespace

std::uint32_t OctreeMap::Windows::add()
{
    std::uint32_t i = size_;
    if (free_.empty())
    {
        if (size_++ % kBlock == 0) blocks_.push_back(std::make_unique<Window[]>(kBlock));
        return i;
    }
    i = free_.back();
    free_.pop_back();
    (*this)[i] = {};
    return i;
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

std::uint32_t OctreeMap::windowAt(Level& level, std::uint64_t corner)
{
    std::uint32_t window = level.index.find(corner);
    if (window != kNoWindow) return window;
    window = level.windows.add();
    level.index.insert(corner, window);
    const octomap::OcTreeKey key = unpack(corner);
    level.windows[window].corner = {key[0], key[1], key[2]};
    return window;
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
    window.plane = isPlane(window, level, thickness2);
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

bool OctreeMap::isOnSideOf(const Window& w, const MapPoint& query)
{
    // The other side of a wall or of a floor is another surface; a grazing view is of either.
    return w.cosine * w.normal.dot(query.view) > -kGrazing * kGrazing;
}

bool OctreeMap::isLine(const Window& w) const
{
    return config.lines && w.width2 < config.max_thickness * config.max_thickness &&
           w.width2 < config.max_flatness * config.max_flatness * w.length2;
}

bool OctreeMap::isThinAsNoise(const Window& w) const
{
    const double noise = std::max(config.min_sigma, range_noise_ * std::abs(w.cosine));
    return w.variance <= config.scale_tolerance * config.scale_tolerance * noise * noise;
}

void OctreeMap::learnRangeNoise() const
{
    // Noise along the rays makes a plane as thick as it is, times the cosine of view and normal.
    if (insertions_ < kYoung) return;
    std::vector<double> noise2;
    noise2.reserve(searches_.size());
    for (const Search& s : searches_)
    {
        if (s.best_level < 0 || s.line) continue;
        const Window& w = levels_[static_cast<std::size_t>(s.best_level)].windows[s.best];
        if (std::abs(w.cosine) > kGrazing) noise2.push_back(w.variance / (w.cosine * w.cosine));
    }
    if (noise2.empty()) return;
    const auto thin =
        noise2.begin() + static_cast<std::ptrdiff_t>(kThin * static_cast<double>(noise2.size()));
    std::nth_element(noise2.begin(), thin, noise2.end());
    range_noise_ = std::sqrt(*thin);
}

Correspondence OctreeMap::planeAt(const Vector3d& query, const Window& window) const
{
    Correspondence c;
    const Vector3d d = query - window.mean;
    const double distance = window.normal.dot(d);
    if (std::abs(distance) > config.gate) return c;
    c.surface = Surface::Plane;
    c.direction = window.normal;
    c.point = window.mean;
    // Noise of a new point on the surface, and of the fitted plane at the query.
    const double along = window.axis.dot(d);
    const double across2 = std::max(0.0, d.squaredNorm() - distance * distance - along * along);
    const double leverage =
        (1 + along * along / window.length2 + across2 / window.width2) / window.count;
    c.sigma = std::sqrt(window.variance * (1 + leverage));
    return c;
}

Correspondence OctreeMap::lineAt(const Vector3d& query, const Window& window) const
{
    Correspondence c;
    const Vector3d d = query - window.mean;
    const double along = window.axis.dot(d);
    if (d.squaredNorm() - along * along > config.gate * config.gate) return c;
    c.surface = Surface::Line;
    c.direction = window.axis;
    c.point = window.mean;
    c.sigma = std::sqrt(std::max(window.width2, config.min_sigma * config.min_sigma));
    return c;
}

void OctreeMap::findWindows(int l) const
{
    // Each step waits for memory: it begins for all queries before the next one needs it.
    Level& level = levels_[static_cast<std::size_t>(l)];
    for (std::size_t i = 0; i < searches_.size(); i++)
    {
        if (!searches_[i].active) continue;
        const std::uint64_t corner = cornerOf(searches_[i].cell, l);
        Lookup& last = lookup(i, l);
        if (last.corner != corner) last = {corner, kNoWindow};
        if (last.window == kNoWindow) level.index.prefetch(corner);
    }
    for (std::size_t i = 0; i < searches_.size(); i++)
    {
        Search& search = searches_[i];
        if (!search.active) continue;
        Lookup& last = lookup(i, l);
        if (last.window == kNoWindow) last.window = windowAt(level, last.corner);
        search.window = last.window;
        search.last_level = static_cast<std::int8_t>(l);
        __builtin_prefetch(&level.windows[last.window]);
    }
}

void OctreeMap::refreshStale(int l, Executor& executor) const
{
    Windows& windows = levels_[static_cast<std::size_t>(l)].windows;
    std::vector<std::uint32_t> stale;
    for (const Search& search : searches_)
    {
        if (!search.active) continue;
        Window& window = windows[search.window];
        if (!isStale(window)) continue;
        window.age = window.checked == 0 ? 0 : insertions_ - window.checked;
        window.checked = insertions_;
        window.prefetchPlaces();
        stale.push_back(search.window);
    }
    // Waking a thread takes as long as some tens of windows do.
    executor.forChunks(
        stale.size(), std::max<std::size_t>(kWindowChunk, (stale.size() + 3) / 4),
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
                for (const StatisticsTree::Place& place : windows[stale[i]].places)
                    if (place.node != nullptr) place.node->prefetch();
            for (std::size_t i = begin; i < end; i++) locate(windows[stale[i]], l);
            for (std::size_t i = begin; i < end; i++) refresh(windows[stale[i]], l);
        });
}

void OctreeMap::advance(Search& search, const MapPoint& query, int l) const
{
    const auto& windows = levels_[static_cast<std::size_t>(l)].windows;
    const Window& w = windows[search.window];
    const auto take = [&](bool line)
    {
        search.best = search.window;
        search.best_level = static_cast<std::int8_t>(l);
        search.line = line;
        __builtin_prefetch(&w.mean);
        search.active = line || !isThinAsNoise(w);
    };
    if (w.count == 0)
    {
        search.active = false;  // smaller windows hold still fewer
        return;
    }
    const FeatureKind kind = query.kind;
    const bool plane = kind != FeatureKind::Edge && w.plane && isOnSideOf(w, query);
    if (search.best_level < 0 || search.line)
    {
        if (plane)
            take(false);
        else if (search.best_level < 0 && kind != FeatureKind::Plane && w.line)
            take(true);
        return;
    }
    // A plane is at hand: a smaller window replaces it only if it is thinner beyond doubt. One that
    // is not does not end the search: where a step runs through both, the next may lie beside it.
    const auto& best_windows = levels_[static_cast<std::size_t>(search.best_level)].windows;
    const double tolerance = config.scale_tolerance * config.scale_tolerance;
    if (plane && best_windows[search.best].variance > tolerance * w.largest_variance) take(false);
}

OctreeMap::Search OctreeMap::searchOf(const MapPoint& query) const
{
    Search search;
    search.cell = cellOf(query.position);
    search.active = search.cell != Cell{};
    search.kind = query.kind;
    search.view = query.view;
    return search;
}

bool OctreeMap::isSettled(const MapPoint& query, std::size_t i) const
{
    const Search& search = searches_[i];
    if (search.kind != query.kind || (search.view - query.view).squaredNorm() > kSameView)
        return false;
    const Cell cell = cellOf(query.position);
    for (int l = config.scales - 1; l >= search.last_level; l--)
        if (cornerOf(cell, l) != lookup(i, l).corner) return false;
    return search.last_level < config.scales;
}

void OctreeMap::match(
    const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
    Executor& executor) const
{
    correspondences.assign(queries.size(), {});
    if (empty()) return;
    const std::size_t lookups = queries.size() * levels_.size();
    if (lookups_insertion_ != insertions_ || lookups_.size() != lookups ||
        searches_.size() != queries.size())
    {
        lookups_.assign(lookups, {});
        searches_.assign(queries.size(), {});
        lookups_insertion_ = insertions_;
    }
    for (std::size_t i = 0; i < queries.size(); i++)
        if (!isSettled(queries[i], i)) searches_[i] = searchOf(queries[i]);
    for (int level = config.scales - 1; level >= 0; level--)
    {
        findWindows(level);
        refreshStale(level, executor);
        for (std::size_t i = 0; i < queries.size(); i++)
            if (searches_[i].active) advance(searches_[i], queries[i], level);
    }
    for (Search& search : searches_) search.active = false;
    learnRangeNoise();
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        const Search& s = searches_[i];
        if (s.best_level < 0) continue;
        const Window& w = levels_[static_cast<std::size_t>(s.best_level)].windows[s.best];
        correspondences[i] =
            s.line ? lineAt(queries[i].position, w) : planeAt(queries[i].position, w);
    }
}
}  // namespace taut
