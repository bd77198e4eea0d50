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
constexpr std::uint32_t kMaxPatience = 15;  // insertions
constexpr double kGrowth = 1.2;             // of a window's points, that it is computed anew
constexpr double kDoubt = 3;                // deviations of the thickness of a smaller window
constexpr double kThin = 0.1;               // quantile of the planes that tells the noise
constexpr std::uint32_t kYoung = 30;        // insertions: a young map is as thick as it is wrong
constexpr double kSameView = 1e-3;          // squared, between iterations
constexpr double kGrazing = 0.05;           // cosine to the normal
}  // namespace

bool OctreeMap::cornerOf(const Vector3d& p, int level, std::array<std::uint16_t, 3>& corner) const
{
    // The key of the node just above the node corner that is nearest to p.
    const double edge = config.leaf_size * (1 << level);
    for (int i = 0; i < 3; i++)
    {
        const double nearest = std::floor((p[i] - origin_[i]) / edge + 0.5) * (1 << level) + 32768;
        if (!(nearest >= 256 && nearest < 65280)) return false;
        corner[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(nearest);
    }
    return true;
}

std::uint32_t OctreeMap::windowAt(Level& level, const std::array<std::uint16_t, 3>& corner) const
{
    const auto [it, added] = level.index.try_emplace(pack(corner[0], corner[1], corner[2]), 0u);
    if (added)
    {
        if (level.free.empty())
        {
            it.value() = static_cast<std::uint32_t>(level.windows.size());
            level.windows.emplace_back();
        }
        else
        {
            it.value() = level.free.back();
            level.free.pop_back();
            level.windows[it.value()] = {};
        }
        level.windows[it.value()].corner = corner;
    }
    return it->second;
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
        const double min_width = config.min_spread * config.leaf_size * (1 << level);
        window.min_width2 = min_width * min_width;
        compute(window, sum);
    }
    schedule(window, count);
}

void OctreeMap::schedule(Window& window, double count) const
{
    // Few new points change a surface little: it is kept until a tenth more have come, and not
    // looked at before they are expected.
    const double arrived = count - window.seen;
    const double missing = std::max<double>(config.min_points, kGrowth * window.count) - count;
    window.seen = count;
    window.patience = 0;
    if (window.age == 0) return;
    window.patience = missing * window.age < kMaxPatience * arrived
                          ? static_cast<std::uint32_t>(missing * window.age / arrived)
                          : kMaxPatience;
}

void OctreeMap::compute(Window& window, const PointStatistics& statistics) const
{
    window.count = statistics.count;
    window.mean = statistics.mean();
    window.view = statistics.views / statistics.count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(Eigen::Matrix3d(statistics.scatter() / statistics.count));
    window.normal = eigen.eigenvectors().col(0);
    window.axis = eigen.eigenvectors().col(2);
    // Three degrees of freedom went into the plane.
    window.thickness2 =
        std::max(0.0, eigen.eigenvalues()[0]) * statistics.count / (statistics.count - 3);
    window.width2 = std::max(0.0, eigen.eigenvalues()[1]);
    window.length2 = std::max(0.0, eigen.eigenvalues()[2]);
}

bool OctreeMap::isPlane(const Window& w) const
{
    return w.count >= config.min_points &&
           w.thickness2 < config.max_thickness * config.max_thickness &&
           w.thickness2 < config.max_flatness * config.max_flatness * w.width2 &&
           w.width2 > config.min_width * config.min_width && w.width2 > w.min_width2;
}

bool OctreeMap::isOnSideOf(const Window& w, const MapPoint& query)
{
    // The other side of a wall or of a floor is another surface; a grazing view is of either.
    return w.normal.dot(w.view) * w.normal.dot(query.view) > -kGrazing * kGrazing;
}

bool OctreeMap::isLine(const Window& w) const
{
    return config.lines && w.count >= config.min_points &&
           w.width2 < config.max_thickness * config.max_thickness &&
           w.width2 < config.max_flatness * config.max_flatness * w.length2;
}

double OctreeMap::variance(const Window& window) const
{
    return std::max(window.thickness2, config.min_sigma * config.min_sigma);
}

double OctreeMap::largestVariance(const Window& window) const
{
    // The relative deviation of a variance from n - 3 residuals is sqrt(2 / (n - 3)).
    return variance(window) * (1 + kDoubt * std::sqrt(2 / (window.count - 3)));
}

bool OctreeMap::isThinAsNoise(const Window& w) const
{
    const double noise = std::max(config.min_sigma, range_noise_ * std::abs(w.normal.dot(w.view)));
    return variance(w) <= config.scale_tolerance * config.scale_tolerance * noise * noise;
}

void OctreeMap::learnRangeNoise() const
{
    // Noise along the rays makes a plane as thick as it is, times the cosine of view and normal.
    if (insertions_ < kYoung) return;
    std::vector<double> noise;
    noise.reserve(searches_.size());
    for (const Search& s : searches_)
    {
        if (s.best_level < 0 || s.line) continue;
        const Window& w = levels_[static_cast<std::size_t>(s.best_level)].windows[s.best];
        const double cosine = std::abs(w.normal.dot(w.view));
        if (cosine > kGrazing) noise.push_back(std::sqrt(variance(w)) / cosine);
    }
    if (noise.empty()) return;
    const auto thin =
        noise.begin() + static_cast<std::ptrdiff_t>(kThin * static_cast<double>(noise.size()));
    std::nth_element(noise.begin(), thin, noise.end());
    range_noise_ = *thin;
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
    c.sigma = std::sqrt(variance(window) * (1 + leverage));
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

void OctreeMap::findWindows(const std::vector<MapPoint>& queries, int l, Executor& executor) const
{
    Level& level = levels_[static_cast<std::size_t>(l)];
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        if (!searches_[i].active) continue;
        std::array<std::uint16_t, 3> corner;
        if (!queries[i].position.allFinite() || !cornerOf(queries[i].position, l, corner))
        {
            searches_[i].active = false;
            continue;
        }
        Lookup& last = lookups_[i * levels_.size() + static_cast<std::size_t>(l)];
        if (last.window == kNoWindow || last.corner != corner)
            last = {corner, windowAt(level, corner)};
        searches_[i].window = last.window;
        searches_[i].last_level = static_cast<std::int8_t>(l);
        level.prefetch(last.window);
    }
    std::vector<std::uint32_t> stale;
    for (const Search& search : searches_)
    {
        if (!search.active) continue;
        Window& window = level.windows[search.window];
        if (!isStale(window)) continue;
        window.age = window.checked == 0 ? 0 : insertions_ - window.checked;
        window.checked = insertions_;
        stale.push_back(search.window);
    }
    executor.forChunks(
        stale.size(), 32,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++) locate(level.windows[stale[i]], l);
            for (std::size_t i = begin; i < end; i++) refresh(level.windows[stale[i]], l);
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
        search.active = line || !isThinAsNoise(w);
    };
    if (w.count < config.min_points)
    {
        search.active = false;  // smaller windows hold still fewer
        return;
    }
    const FeatureKind kind = query.kind;
    const bool plane = kind != FeatureKind::Edge && isPlane(w) && isOnSideOf(w, query);
    if (search.best_level < 0 || search.line)
    {
        if (plane)
            take(false);
        else if (search.best_level < 0 && kind != FeatureKind::Plane && isLine(w))
            take(true);
        return;
    }
    // A plane is at hand: a smaller window replaces it only if it is thinner beyond doubt. One that
    // is not does not end the search: where a step runs through both, the next may lie beside it.
    const auto& best_windows = levels_[static_cast<std::size_t>(search.best_level)].windows;
    const double tolerance = config.scale_tolerance * config.scale_tolerance;
    if (plane && variance(best_windows[search.best]) > tolerance * largestVariance(w)) take(false);
}

bool OctreeMap::isSettled(const MapPoint& query, std::size_t i) const
{
    const Search& search = searches_[i];
    if (search.kind != query.kind || (search.view - query.view).squaredNorm() > kSameView ||
        !query.position.allFinite())
        return false;
    for (int l = config.scales - 1; l >= search.last_level; l--)
    {
        std::array<std::uint16_t, 3> corner;
        if (!cornerOf(query.position, l, corner) ||
            corner != lookups_[i * levels_.size() + static_cast<std::size_t>(l)].corner)
            return false;
    }
    return search.last_level < config.scales;
}

void OctreeMap::match(
    const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
    Executor& executor) const
{
    const std::size_t lookups = queries.size() * levels_.size();
    if (lookups_insertion_ != insertions_ || lookups_.size() != lookups)
    {
        lookups_.assign(lookups, {});
        searches_.assign(queries.size(), {});
        lookups_insertion_ = insertions_;
    }
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        if (isSettled(queries[i], i)) continue;
        searches_[i] = {};
        searches_[i].kind = queries[i].kind;
        searches_[i].view = queries[i].view;
    }
    for (int level = config.scales - 1; level >= 0; level--)
    {
        findWindows(queries, level, executor);
        for (std::size_t i = 0; i < queries.size(); i++)
            if (searches_[i].active) advance(searches_[i], queries[i], level);
    }
    for (Search& search : searches_) search.active = false;
    learnRangeNoise();
    correspondences.assign(queries.size(), {});
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
