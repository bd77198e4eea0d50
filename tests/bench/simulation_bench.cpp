#include <benchmark/benchmark.h>

#include "taut/simulation/Simulator.h"

using namespace taut;
using namespace taut::simulation;

namespace
{
Scenario scenarioOf(WorldType world, LidarType lidar)
{
    Scenario s;
    s.duration = 4;
    s.rest = 0;
    s.world.type = world;
    s.motion = motionPreset(MotionPreset::Walk);
    s.lidar = lidarPreset(lidar);
    s.imu = imuPreset(ImuPreset::Industrial);
    return s;
}

/** One sweep after the other, on as many threads as the argument says. Simulating a minute takes
 * 600 of them. */
void sweeps(benchmark::State& state, WorldType world, LidarType lidar)
{
    const Simulator simulator(scenarioOf(world, lidar));
    Executor executor(static_cast<int>(state.range(0)));
    std::size_t points = 0;
    int k = 0;
    for (auto _ : state)
    {
        points += simulator.sweep(k, executor).scan.points.size();
        k = (k + 1) % simulator.sweeps();
    }
    state.counters["points/s"] =
        benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
}
}  // namespace

BENCHMARK_CAPTURE(sweeps, hall_vlp16, WorldType::Hall, LidarType::Vlp16)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sweeps, forest_os1_64, WorldType::Forest, LidarType::Os1_64)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
