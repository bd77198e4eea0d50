// How OctreeMap finds the surface of a query: the search through the sizes of its windows.
#include <algorithm>
#include <cmath>

#include "taut/map/OctreeMap.h"

namespace taut
{
namespace
{
constexpr double kThin = 0.1;                // quantile of the planes that tells the noise
constexpr std::uint32_t kYoung = 30;         // insertions: a young map is as thick as it is wrong
constexpr std::uint32_t kLearningPause = 4;  // insertions, of which it learns from one
constexpr std::size_t kLearntFrom = 200;     // points of an insertion, about
constexpr double kGrazing = 0.05;            // cosine to the normal
}  // namespace

void OctreeMap::match(
    const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
    MapScratch& map_scratch, Executor& executor) const
{
    correspondences.assign(queries.size(), {});
    if (empty()) return;
    auto& scratch = map_scratch.as<Scratch>();
    search(queries, scratch, executor);
    for (std::size_t i = 0; i < queries.size(); i++)
    {
        const Search& s = scratch.searches[i];
        if (s.best_level < 0) continue;
        const Window& w = windowOf(scratch, s.best_level, s.best);
        correspondences[i] =
            s.line ? lineAt(queries[i].position, w) : planeAt(queries[i].position, w);
    }
}

void OctreeMap::search(
    const std::vector<MapPoint>& queries, Scratch& scratch, Executor& executor) const
{
    prepare(scratch, queries.size());
    std::vector<std::uint32_t>& active = scratch.active;
    active.clear();
    for (std::uint32_t i = 0; i < queries.size(); i++)
    {
        if (isSettled(queries[i], scratch, i)) continue;
        scratch.searches[i] = searchOf(queries[i]);
        if (scratch.searches[i].active) active.push_back(i);
    }
    const auto ended = [&](std::uint32_t i) { return !scratch.searches[i].active; };
    for (int level = config.scales - 1; level >= 0; level--)
    {
        findWindows(scratch, level);
        askForWindows(scratch, level, executor);
        for (const std::uint32_t i : active)
            advance(scratch.searches[i], scratch, queries[i], level);
        active.erase(std::remove_if(active.begin(), active.end(), ended), active.end());
    }
}

void OctreeMap::prepare(Scratch& scratch, std::size_t queries) const
{
    if (scratch.state == state_ && scratch.searches.size() == queries) return;
    if (scratch.state != state_)
    {
        scratch.asked.resize(levels_.size());
        for (Asked& asked : scratch.asked) asked.clear();
        scratch.state = state_;
    }
    // Nothing else is written: filling all of it anew would take some percent of a match.
    scratch.epoch++;
    scratch.lookups.resize(queries * levels_.size());
    scratch.searches.resize(queries);
    for (Search& search : scratch.searches) search.last_level = kNoLevel;
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

bool OctreeMap::isSettled(const MapPoint& query, Scratch& scratch, std::size_t i) const
{
    const Search& search = scratch.searches[i];
    if (search.kind != query.kind || search.last_level == kNoLevel) return false;
    if (!((search.view - query.view).squaredNorm() < search.view_reach * search.view_reach))
        return false;
    const Cell cell = cellOf(query.position);
    for (int l = config.scales - 1; l >= search.last_level; l--)
        if (cornerOf(cell, l) != scratch.lookup(i, l).corner) return false;
    return true;
}

void OctreeMap::findWindows(Scratch& scratch, int l) const
{
    // Each step waits for memory: it begins for all queries before the next one needs it.
    const Level& kept = levels_[static_cast<std::size_t>(l)];
    for (const std::uint32_t i : scratch.active)
    {
        const std::uint64_t corner = cornerOf(scratch.searches[i].cell, l);
        Lookup& last = scratch.lookup(i, l);
        if (last.corner != corner || last.epoch != scratch.epoch)
            last = {corner, kNoWindow, scratch.epoch};
        if (last.window == kNoWindow) kept.index.prefetch(corner);
    }
    for (const std::uint32_t i : scratch.active)
    {
        Lookup& last = scratch.lookup(i, l);
        scratch.searches[i].last_level = static_cast<std::int8_t>(l);
        if (last.window == kNoWindow) last.window = kept.index.find(last.corner);
        if (last.window != kNoWindow) __builtin_prefetch(&windowOf(scratch, l, last.window));
    }
}

void OctreeMap::askForWindows(Scratch& scratch, int l, Executor& executor) const
{
    const Windows& kept = levels_[static_cast<std::size_t>(l)].windows;
    Asked& asked = scratch.asked[static_cast<std::size_t>(l)];
    const auto known = static_cast<std::uint32_t>(asked.kept.size());
    for (const std::uint32_t i : scratch.active)
    {
        Lookup& last = scratch.lookup(i, l);
        if (!isDue(kept, last.window)) continue;
        const std::uint32_t number = asked.at(last.corner);
        if (number == asked.kept.size())
        {
            asked.kept.push_back(last.window);
            if (last.window != kNoWindow) kept[last.window].prefetchCheck();
        }
        last.window = number | kAsked;
    }
    makeAsked(asked, known, l, executor);
    for (const std::uint32_t i : scratch.active)
    {
        const std::uint32_t found = scratch.lookup(i, l).window;
        scratch.searches[i].window = (found & kAsked) != 0 ? asked.shown[found & ~kAsked] : found;
    }
}

bool OctreeMap::isDue(const Windows& kept, std::uint32_t number) const
{
    return number == kNoWindow || ((number & kAsked) == 0 && isStale(kept[number]));
}

void OctreeMap::makeAsked(Asked& asked, std::uint32_t first, int l, Executor& executor) const
{
    const Windows& kept = levels_[static_cast<std::size_t>(l)].windows;
    std::vector<std::uint32_t> made;
    for (auto number = first; number < asked.kept.size(); number++)
    {
        Window& window = asked.windows[number];
        if (asked.kept[number] != kNoWindow) window.takeCheck(kept[asked.kept[number]]);
        window.age = window.checked == 0 ? 0 : insertions_ - window.checked;
        window.checked = insertions_;
        made.push_back(number);
    }
    refreshAll(asked.windows, made, l, executor);
    for (const std::uint32_t number : made)
    {
        const std::uint32_t before = asked.kept[number];
        const bool is_same =
            before != kNoWindow && kept[before].count == asked.windows[number].count;
        asked.shown.push_back(is_same ? before : number | kAsked);
    }
}

const OctreeMap::Window& OctreeMap::windowOf(
    const Scratch& scratch, int level, std::uint32_t number) const
{
    const auto l = static_cast<std::size_t>(level);
    return (number & kAsked) != 0 ? scratch.asked[l].windows[number & ~kAsked]
                                  : levels_[l].windows[number];
}

void OctreeMap::advance(Search& search, const Scratch& scratch, const MapPoint& query, int l) const
{
    const Window& w = windowOf(scratch, l, search.window);
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
    const bool plane = kind != FeatureKind::Edge && w.plane && isOnSideOf(w, search);
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
    const Window& best = windowOf(scratch, search.best_level, search.best);
    const double tolerance = config.scale_tolerance * config.scale_tolerance;
    if (plane && best.variance > tolerance * w.largest_variance) take(false);
}

bool OctreeMap::isOnSideOf(const Window& w, Search& search)
{
    // The other side of a wall or of a floor is another surface; a grazing view is of either.
    const double on_side = w.cosine * w.normal.dot(search.view) + kGrazing * kGrazing;
    // A change of the view moves this by no more than its length times the cosine.
    constexpr double kRounded = 0.999;
    search.view_reach =
        std::min(search.view_reach, kRounded * std::abs(on_side) / std::abs(w.cosine));
    return on_side > 0;
}

bool OctreeMap::isThinAsNoise(const Window& w) const
{
    const double noise = std::max(config.min_sigma, range_noise_ * std::abs(w.cosine));
    return w.variance <= config.scale_tolerance * config.scale_tolerance * noise * noise;
}

void OctreeMap::learnRangeNoise(const std::vector<MapPoint>& points, Executor& executor)
{
    // Noise along the rays makes a plane as thick as it is, times the cosine of view and normal.
    if (insertions_ < kYoung || insertions_ % kLearningPause != 0 || empty()) return;
    std::vector<MapPoint> sample;
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kLearntFrom);
    for (std::size_t i = 0; i < points.size(); i += stride) sample.push_back(points[i]);
    search(sample, learning_, executor);
    std::vector<double> noise2;
    noise2.reserve(sample.size());
    for (const Search& s : learning_.searches)
    {
        if (s.best_level < 0 || s.line) continue;
        const Window& w = windowOf(learning_, s.best_level, s.best);
        if (std::abs(w.cosine) > kGrazing) noise2.push_back(w.variance / (w.cosine * w.cosine));
    }
    keep(learning_);
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
}  // namespace taut
