#include <benchmark/benchmark.h>

#include "scenes.h"
#include "taut/map/KdTreeMap.h"
#include "taut/map/OccupancyMap.h"

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

constexpr std::size_t kFeatures = 3000;  // of a scan

/** A walk through a long hall: the features of its scans, in the world. */
std::vector<std::vector<MapPoint>> walk(int scans, double step)
{
    std::vector<std::vector<MapPoint>> features;
    for (int s = 0; s < scans; s++)
    {
        const double x = step * s;
        Scene scene;
        scene.room = {{-30 - x, -20, -1.8}, {200 - x, 25, 10}};
        scene.obstacles = {{{40 - x, 3, -1.8}, {44 - x, 9, 3}}};
        const Scan scan =
            SpinningLidar{32, 1024, -25, 15}.scan(scene, 1 + static_cast<unsigned>(s));
        const std::size_t every = scan.points.size() / kFeatures;
        features.emplace_back();
        for (std::size_t i = 0; i < scan.points.size(); i += every)
            features.back().push_back(
                {scan.points[i].position.cast<double>() + Vector3d(x, 0, 0),
                 i % (10 * every) == 0 ? FeatureKind::Edge : FeatureKind::Plane});
    }
    return features;
}

const std::vector<std::vector<MapPoint>>& walkOf200()
{
    static const auto features = walk(200, 0.3);
    return features;
}

void kdTreeMapInsert(benchmark::State& state)
{
    KdTreeMap map;
    std::size_t scan = 0;
    for (auto _ : state)
    {
        if (scan == walkOf200().size())
        {
            map.clear();
            scan = 0;
        }
        map.insert(walkOf200()[scan], single);
        map.slide({0.3 * static_cast<double>(scan++), 0, 0});
    }
    state.counters["cells"] = static_cast<double>(map.size());
}
BENCHMARK(kdTreeMapInsert)->Unit(benchmark::kMillisecond)->Iterations(1000);

void kdTreeMapMatch(benchmark::State& state)
{
    KdTreeMap map;
    for (const auto& features : walkOf200()) map.insert(features, single);
    Executor executor(static_cast<int>(state.range(0)));
    std::vector<Correspondence> found;
    MapScratch scratch;
    for (auto _ : state) map.match(walkOf200()[150], found, scratch, executor);
    std::size_t matched = 0;
    for (const Correspondence& c : found) matched += c.surface != Surface::None;
    state.counters["queries"] = static_cast<double>(found.size());
    state.counters["matched"] = static_cast<double>(matched);
    state.counters["cells"] = static_cast<double>(map.size());
}
BENCHMARK(kdTreeMapMatch)
    ->Unit(benchmark::kMillisecond)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();

/** Scans that went through the voxel thinning, as the occupancy map gets them. */
void occupancyInsert(benchmark::State& state)
{
    OccupancyMap map;
    std::size_t scan = 0;
    std::vector<Vector3d> points;
    for (auto _ : state)
    {
        state.PauseTiming();
        points.clear();
        for (const MapPoint& p : walkOf200()[scan]) points.push_back(p.position);
        const Vector3d origin(0.3 * static_cast<double>(scan), 0, 0);
        scan = (scan + 1) % walkOf200().size();
        state.ResumeTiming();
        map.insert(0, origin, points, {});
    }
    state.counters["nodes"] = static_cast<double>(map.tree().size());
}
BENCHMARK(occupancyInsert)->Unit(benchmark::kMillisecond)->Iterations(200);
}  // namespace
