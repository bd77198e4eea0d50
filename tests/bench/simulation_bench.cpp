#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "program.h"
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

/** The whole program, writing included, on all cores: it shall not take longer than the minute. */
void aMinuteOfVlp16(benchmark::State& state)
{
    const auto folder =
        std::filesystem::temp_directory_path() / ("taut_bench_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    for (auto _ : state)
    {
        const test::ProgramRun run = test::runProgram(
            TAUT_SIMULATE, "-q -c " TAUT_CONFIG "/scenarios/hall_violent.yaml -o " +
                               (folder / "log.rawlog").string() +
                               " --set duration=60 --set lidar.type=VLP-16");
        if (run.exit_code != 0) state.SkipWithError(run.output.c_str());
    }
    std::filesystem::remove_all(folder);
}
}  // namespace

BENCHMARK(aMinuteOfVlp16)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(sweeps, hall_vlp16, WorldType::Hall, LidarType::Vlp16)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sweeps, forest_os1_64, WorldType::Forest, LidarType::Os1_64)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
