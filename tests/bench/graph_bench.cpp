#include <benchmark/benchmark.h>

#include <cmath>

#include "numeric.h"
#include "taut/graph/SparseGraphOptimizer.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr int kVertices = 10000, kClosures = 5000;

Vector6d noise(Random& random, double p, double theta)
{
    Vector6d d;
    d << random.vector(p), random.vector(theta);
    return d;
}

RelativeEdge edge(
    const std::vector<Pose>& truth, VertexId from, VertexId to, EdgeKind kind, Random& random)
{
    constexpr double kPosition = 0.02, kRotation = 0.001;
    const Vector6d d = noise(random, kPosition, kRotation);
    RelativeEdge e;
    e.from = from;
    e.to = to;
    e.kind = kind;
    e.T_from_to = truth[from].inverse() * truth[to] * Pose{expSO3(d.tail<3>()), d.head<3>()};
    e.information.diagonal() << Vector3d::Constant(1 / square(kPosition)),
        Vector3d::Constant(1 / square(kRotation));
    return e;
}

/** Positions 10 m apart, with the odometry's drift in the graph. */
PoseGraph chain(const std::vector<Pose>& truth, Random& random)
{
    PoseGraph graph;
    graph.vertices.push_back({0, truth[0], true});
    for (VertexId i = 0; i + 1 < static_cast<VertexId>(truth.size()); i++)
    {
        graph.relative_edges.push_back(edge(truth, i, i + 1, EdgeKind::Odometry, random));
        graph.vertices.push_back(
            {i + 1, graph.vertices.back().T_world_submap * graph.relative_edges.back().T_from_to});
    }
    return graph;
}

/** Laps around a course of 5 km; each closure ties a place to the same one some laps ago. */
PoseGraph laps(double false_share)
{
    constexpr int kLap = 500;
    Random random(1);
    std::vector<Pose> truth;
    for (int i = 0; i < kVertices; i++)
    {
        const double angle = 2 * M_PI * i / kLap, radius = 800 * (1 + 0.2 * std::sin(3 * angle));
        truth.push_back(
            {expSO3({0, 0, angle}),
             {radius * std::cos(angle), radius * std::sin(angle), 20 * std::sin(2 * angle)}});
    }
    PoseGraph graph = chain(truth, random);
    for (int k = 0; k < kClosures; k++)
    {
        const auto to = static_cast<VertexId>(random.uniform(kLap, kVertices));
        const auto ago = static_cast<VertexId>(random.uniform(1, 4));
        const VertexId from = to % kLap + kLap * std::max<VertexId>(0, to / kLap - ago);
        graph.relative_edges.push_back(edge(truth, from, to, EdgeKind::LoopClosure, random));
        if (random.uniform(0, 1) < false_share)
            graph.relative_edges.back().from = static_cast<VertexId>(random.uniform(0, kLap / 2));
        if (graph.relative_edges.back().from == to) graph.relative_edges.pop_back();
    }
    return graph;
}

/** A walk along the streets of a city of 40 x 40 crossings: the worst case for elimination. */
PoseGraph city()
{
    constexpr int kCrossings = 40, kBlock = 5;  // 5 vertices, 50 m, from crossing to crossing
    constexpr int kCells = kCrossings * kBlock;
    Random random(2);
    std::vector<Pose> truth;
    std::vector<std::vector<VertexId>> seen(kCells * kCells);
    std::vector<std::pair<VertexId, VertexId>> again;
    int x = kCells / 2, y = kCells / 2, dx = 1, dy = 0;
    for (VertexId i = 0; i < kVertices; i++)
    {
        truth.push_back({expSO3({0, 0, std::atan2(dy, dx)}), {10.0 * x, 10.0 * y, 0}});
        auto& here = seen[x * kCells + y];
        for (VertexId before : here) again.emplace_back(before, i);
        here.push_back(i);
        if (x % kBlock == 0 && y % kBlock == 0 && random.uniform(0, 1) < 0.5)
        {
            const int turn = random.uniform(0, 1) < 0.5 ? 1 : -1, old = dx;
            dx = -turn * dy;
            dy = turn * old;
        }
        if (x + dx < 0 || x + dx >= kCells) dx = -dx;
        if (y + dy < 0 || y + dy >= kCells) dy = -dy;
        x += dx;
        y += dy;
    }
    PoseGraph graph = chain(truth, random);
    const std::size_t step = std::max<std::size_t>(1, again.size() / kClosures);
    for (std::size_t k = 0; k < again.size(); k += step)
        graph.relative_edges.push_back(
            edge(truth, again[k].first, again[k].second, EdgeKind::LoopClosure, random));
    return graph;
}

void optimize(benchmark::State& state, const PoseGraph& start)
{
    GraphReport report;
    for (auto _ : state)
    {
        PoseGraph graph = start;
        report = SparseGraphOptimizer().optimize(graph);
        benchmark::DoNotOptimize(graph.vertices.back().T_world_submap.p);
    }
    state.counters["edges"] = static_cast<double>(start.relative_edges.size());
    state.counters["iterations"] = report.iterations;
    state.counters["converged"] = report.converged;
    state.counters["chi2_per_edge"] =
        2 * report.final_cost / static_cast<double>(start.relative_edges.size());
}

void graphOfLaps(benchmark::State& state)
{
    optimize(state, laps(0));
}
BENCHMARK(graphOfLaps)->Unit(benchmark::kMillisecond)->Iterations(1);

void graphOfLapsWithFalseClosures(benchmark::State& state)
{
    optimize(state, laps(0.1));
}
BENCHMARK(graphOfLapsWithFalseClosures)->Unit(benchmark::kMillisecond)->Iterations(1);

void graphOfACity(benchmark::State& state)
{
    optimize(state, city());
}
BENCHMARK(graphOfACity)->Unit(benchmark::kMillisecond)->Iterations(1);

void covarianceOfLaps(benchmark::State& state)
{
    const PoseGraph graph = laps(0);
    Matrix6d sum = Matrix6d::Zero();
    for (auto _ : state)
    {
        const auto covariance = SparseGraphOptimizer().covariance(graph, {});
        sum += covariance->relative(100, 9000);
    }
    benchmark::DoNotOptimize(sum);
}
BENCHMARK(covarianceOfLaps)->Unit(benchmark::kMillisecond)->Iterations(1);
}  // namespace
