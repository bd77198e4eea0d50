#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "numeric.h"
#include "taut/core/PoseGraph.h"

/** \file graphs.h
 * Pose graphs with truth. */
namespace taut::test
{
inline Pose exp(const Vector6d& d)
{
    return {expSO3(d.tail<3>()), d.head<3>()};
}

inline Vector6d tangent(double p, double theta)
{
    return (Vector6d() << p, p, p, theta, theta, theta).finished();
}

/** Of independent errors with these deviations. */
inline Matrix6d informationOf(const Vector6d& sigmas)
{
    return sigmas.cwiseInverse().cwiseAbs2().asDiagonal();
}

/** A symmetric matrix with eigenvalues from 1 to about 100 and no zero entry. */
template <int N>
Eigen::Matrix<double, N, N> anyInformation(Random& random)
{
    Eigen::Matrix<double, N, N> A;
    for (int i = 0; i < N * N; i++) A(i / N, i % N) = random.uniform(-3, 3);
    return A * A.transpose() + Eigen::Matrix<double, N, N>::Identity();
}

inline Pose anyPose(Random& random, double position, double rotation)
{
    return {expSO3(random.vector(rotation)), random.vector(position)};
}

inline Vector6d noise(Random& random, const Vector6d& sigmas)
{
    Vector6d d;
    for (int i = 0; i < 6; i++) d[i] = sigmas[i] * random.normal();
    return d;
}

/** An edge that measures the truth with noise. */
inline RelativeEdge measured(
    const std::vector<Pose>& truth, VertexId from, VertexId to, EdgeKind kind,
    const Vector6d& sigmas, Random& random)
{
    RelativeEdge e;
    e.from = from;
    e.to = to;
    e.kind = kind;
    e.information = informationOf(sigmas);
    e.T_from_to = truth[from].inverse() * truth[to] * exp(noise(random, sigmas));
    return e;
}

/** Vertices 0, 1, ... where the odometry says they are, the first at its true pose. */
inline void chainVertices(PoseGraph& graph, const Pose& first)
{
    graph.vertices = {{0, first, true}};
    for (const RelativeEdge& e : graph.relative_edges)
        if (e.kind == EdgeKind::Odometry)
            graph.vertices.push_back(
                {e.to, graph.vertices.back().T_world_submap * e.T_from_to, false});
}

struct GraphWithTruth
{
    PoseGraph graph;
    std::vector<Pose> truth;                  // of vertex i
    std::vector<std::size_t> false_closures;  // positions of edges
};

/** Two laps around a circle of 30 m that rises and falls, each vertex seen again in the second. */
inline GraphWithTruth twoLaps(int vertices, unsigned seed)
{
    GraphWithTruth result;
    Random random(seed);
    const int lap = vertices / 2;
    for (int i = 0; i < vertices; i++)
    {
        const double angle = 2 * M_PI * i / lap;
        const Pose pose{
            expSO3({0, 0, angle}) * expSO3({0.1 * std::sin(3 * angle), 0.1, 0}),
            {30 * std::cos(angle), 30 * std::sin(angle), std::sin(2 * angle)}};
        result.truth.push_back(pose);
    }
    auto& edges = result.graph.relative_edges;
    for (int i = 0; i + 1 < vertices; i++)
        edges.push_back(
            measured(result.truth, i, i + 1, EdgeKind::Odometry, tangent(0.02, 0.002), random));
    chainVertices(result.graph, result.truth[0]);
    for (int i = 0; i < lap; i++)
        edges.push_back(measured(
            result.truth, i, i + lap, EdgeKind::LoopClosure, tangent(0.05, 0.005), random));
    return result;
}

/** Makes every closure false whose number is drawn: it ties two other places, as if they were one.
 */
inline void falsify(GraphWithTruth& graph, double share, unsigned seed)
{
    Random random(seed);
    const auto n = static_cast<double>(graph.truth.size());
    std::vector<std::size_t> closures;
    for (std::size_t i = 0; i < graph.graph.relative_edges.size(); i++)
        if (graph.graph.relative_edges[i].kind == EdgeKind::LoopClosure) closures.push_back(i);
    std::mt19937_64 engine(seed);
    std::shuffle(closures.begin(), closures.end(), engine);
    closures.resize(
        static_cast<std::size_t>(std::lround(share * static_cast<double>(closures.size()))));
    std::sort(closures.begin(), closures.end());
    for (std::size_t i : closures)
    {
        RelativeEdge& e = graph.graph.relative_edges[i];
        Pose true_pose;
        do {
            e.from = static_cast<VertexId>(random.uniform(0, n));
            e.to = static_cast<VertexId>(random.uniform(0, n));
            true_pose = graph.truth[e.from].inverse() * graph.truth[e.to];
        } while (true_pose.p.norm() < 5);
        e.T_from_to = exp(noise(random, tangent(0.3, 0.1)));
    }
    graph.false_closures = closures;
}

/** Graph of any shape: a bent chain, closures with full information matrices, gravity at each. */
inline GraphWithTruth anyGraph(int vertices, unsigned seed, bool with_gravity)
{
    GraphWithTruth result;
    Random random(seed);
    result.truth.push_back(anyPose(random, 3, 0.5));
    for (int i = 1; i < vertices; i++)
        result.truth.push_back(result.truth.back() * anyPose(random, 1, 0.4));
    auto& edges = result.graph.relative_edges;
    const auto add = [&](int from, int to, EdgeKind kind)
    {
        edges.push_back(measured(result.truth, from, to, kind, tangent(0.05, 0.02), random));
        edges.back().information = 100 * anyInformation<6>(random);
    };
    for (int i = 0; i + 1 < vertices; i++) add(i, i + 1, EdgeKind::Odometry);
    chainVertices(result.graph, result.truth[0]);
    for (int i = 0; i + 5 < vertices; i += 3) add(i + 5, i, EdgeKind::LoopClosure);  // backward too
    for (int i = 0; with_gravity && i < vertices; i++)
    {
        GravityEdge e;
        e.vertex = i;
        e.up_submap =
            (expSO3(random.vector(0.01)) * result.truth[i].R.transpose().col(2)).normalized();
        e.information = 1e3 * anyInformation<3>(random);
        result.graph.gravity_edges.push_back(e);
    }
    return result;
}
}  // namespace taut::test
