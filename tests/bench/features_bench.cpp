#include <benchmark/benchmark.h>

#include "scenes.h"
#include "taut/features/CurvatureExtractor.h"
#include "taut/features/VoxelThinning.h"

using namespace taut;
using namespace taut::test;

namespace
{
const SpinningLidar kVlp16{16, 1800, -15, 15};
const SpinningLidar kOs1{128, 1024, -22.5, 22.5};

const Scene kRoom{{{-7, -5, -1.2}, {9, 6, 2.4}}, {{{2, 1, -1.2}, {3, 2, 1}}}};
const Scene kHall{{{-30, -20, -1.8}, {40, 25, 10}}, {{{8, 4, -1.8}, {10, 9, 3}}}};

template <class Extractor>
void extract(benchmark::State& state, const SpinningLidar& lidar, const Scene& scene)
{
    const Scan scan = lidar.scan(scene);
    const Extractor extractor;
    std::size_t features = 0;
    for (auto _ : state) features = extractor.extract(scan, {}).points.size();
    state.counters["points"] = static_cast<double>(scan.points.size());
    state.counters["features"] = static_cast<double>(features);
}

template <class Extractor>
bool registerExtractor(const std::string& name)
{
    for (const auto& [lidar_name, lidar] : {std::pair("vlp16", kVlp16), {"os1_128", kOs1}})
        for (const auto& [scene_name, scene] : {std::pair("room", kRoom), {"hall", kHall}})
            benchmark::RegisterBenchmark(
                (name + "/" + lidar_name + "/" + scene_name).c_str(), extract<Extractor>, lidar,
                scene)
                ->Unit(benchmark::kMillisecond);
    return true;
}
const bool kRegistered = registerExtractor<VoxelThinning>("VoxelThinning") &&
                         registerExtractor<CurvatureExtractor>("CurvatureExtractor");
}  // namespace
