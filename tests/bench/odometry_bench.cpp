#include <benchmark/benchmark.h>

#include "scenes.h"
#include "taut/core/Plugins.h"
#include "taut/map/OctreeMap.h"
#include "taut/odometry/Odometry.h"
#include "taut/odometry/registerAll.h"
#include "taut/preintegration/MidpointPreintegrator.h"

using namespace taut;
using namespace taut::test;

namespace
{
Executor single;

constexpr Time kStart = 1'700'000'000'000'000'000;
constexpr Duration kSweep = 100'000'000, kImuStep = 5'000'000;

const Scene kHall{{{-30, -20, -1.8}, {40, 25, 10}}, {{{8, 4, -1.8}, {10, 9, 3}}}};

/** A body at rest that looks at a hall: scans with their noise, and the IMU of it. */
struct Recording
{
    std::vector<Scan> scans;
    ImuSamples imu;

    explicit Recording(int n)
    {
        for (int k = 0; k < n; k++)
        {
            Scan scan = SpinningLidar{16, 1800, -15, 15}.scan(kHall, 1 + static_cast<unsigned>(k));
            scan.stamp = kStart + k * kSweep;
            scan.end = scan.stamp + kSweep;
            scans.push_back(std::move(scan));
        }
        for (Time t = kStart - kImuStep; t <= kStart + n * kSweep + kImuStep; t += kImuStep)
            imu.push_back({t, Vector3d::Zero(), kGravityWorld});
    }
};

const Recording& recording()
{
    static const Recording r(20);
    return r;
}

OdometryConfig methodWith(const std::string& solver)
{
    registerAll();
    ConfigSection root(parseYaml("solver: {type: " + solver + "}"));
    return OdometryConfig::read(root);
}

Initialization atRest()
{
    Initialization init;
    init.estimate.state.t = kStart - 1;
    init.estimate.covariance = NavState::Matrix::Identity() * 1e-6;
    return init;
}

void preintegrate(benchmark::State& state)
{
    const MidpointPreintegrator preintegrator;
    PreintegrationRequest request;
    request.begin = kStart;
    request.end = kStart + kSweep;
    request.samples = &recording().imu;
    for (auto _ : state) benchmark::DoNotOptimize(preintegrator.integrate(request));
    state.counters["samples"] = static_cast<double>(kSweep / kImuStep);
}
BENCHMARK(preintegrate)->Unit(benchmark::kMicrosecond);

std::vector<MapPoint> worldPoints(const Scan& scan)
{
    std::vector<MapPoint> points;
    for (const LidarPoint& p : scan.points) points.push_back({p.position.cast<double>()});
    return points;
}

void octreeMapInsert(benchmark::State& state)
{
    OctreeMap map;
    std::size_t k = 0;
    for (auto _ : state)
    {
        state.PauseTiming();
        const auto points = worldPoints(recording().scans[k++ % recording().scans.size()]);
        state.ResumeTiming();
        map.insert(points, single);
    }
    state.counters["nodes"] = static_cast<double>(map.size());
}
BENCHMARK(octreeMapInsert)->Unit(benchmark::kMillisecond)->Iterations(40);

/** Argument: 1 if the map has changed since the look-up before, as in the first iteration of a
 * scan. */
void octreeMapMatch(benchmark::State& state)
{
    OctreeMap map;
    Executor executor(1);
    for (const Scan& scan : recording().scans) map.insert(worldPoints(scan), single);
    const auto all = worldPoints(recording().scans[0]);
    std::vector<MapPoint> queries;
    for (std::size_t i = 0; i < all.size(); i += all.size() / 2000) queries.push_back(all[i]);
    std::vector<Correspondence> found;
    MapScratch scratch;
    for (auto _ : state)
    {
        if (state.range(0) != 0)
        {
            state.PauseTiming();
            map.keep(scratch);
            map.insert(queries, single);
            state.ResumeTiming();
        }
        map.match(queries, found, scratch, executor);
    }
    state.counters["queries"] = static_cast<double>(queries.size());
}
BENCHMARK(octreeMapMatch)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/** The whole scan; what of it is solving is a counter [ms]. Arguments: solver, threads. */
void wholeScan(benchmark::State& state)
{
    const OdometryConfig method =
        methodWith(state.range(0) == 0 ? "taut::GaussNewton" : "taut::NloptSolver");
    Executor executor(static_cast<int>(state.range(1)));
    Odometry odometry(method, executor, {});
    std::size_t k = recording().scans.size();
    StageTimes total;
    double solved = 0;
    for (auto _ : state)
    {
        if (k == recording().scans.size())
        {
            state.PauseTiming();
            odometry.start(atRest());
            odometry.process(recording().scans[0], &recording().imu);
            k = 1;
            state.ResumeTiming();
        }
        const ScanResult r = odometry.process(recording().scans[k++], &recording().imu);
        total.match += r.report.times.match;
        total.solve += r.report.times.solve;
        total.extract += r.report.times.extract;
        total.insert += r.report.times.insert;
        solved += 1;
    }
    state.counters["match_ms"] = total.match / solved;
    state.counters["solve_ms"] = total.solve / solved;
    state.counters["extract_ms"] = total.extract / solved;
    state.counters["insert_ms"] = total.insert / solved;
}
BENCHMARK(wholeScan)->Args({0, 1})->Args({0, 2})->Args({1, 1})->UseRealTime()->Unit(
    benchmark::kMillisecond);
}  // namespace
