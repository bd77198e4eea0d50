#pragma once

#include <cstddef>
#include <vector>

#include "taut/core/PoseGraph.h"

namespace taut
{
/** A graph that has been checked, its vertices in the order of their ids and its edges in an order
 * that depends on their content alone. Points into the graph, which has to outlive it. */
struct IndexedGraph
{
    struct Relative
    {
        int from, to;          // of `vertices`
        std::size_t position;  // in the graph's list
        const RelativeEdge* edge;
    };
    struct Gravity
    {
        int vertex;
        std::size_t position;
        const GravityEdge* edge;
    };

    /** Throws std::invalid_argument with the cause, as GraphOptimizer says. */
    explicit IndexedGraph(const PoseGraph& graph);

    int indexOf(VertexId id) const;  //!< throws std::invalid_argument if it is unknown
    std::vector<Pose> poses() const;

    std::vector<const GraphVertex*> vertices;
    std::vector<std::size_t> positions;  // of the vertices in the graph's list
    std::vector<Relative> relative_edges;
    std::vector<Gravity> gravity_edges;
};

/** Throw std::invalid_argument with the cause if an edge says nothing that makes sense. */
void checkEdge(const RelativeEdge& edge);
void checkEdge(const GravityEdge& edge);

/** Weights in the graph's order: 1 of each edge that is enabled. */
std::vector<double> startingWeights(const IndexedGraph& graph);

/** Those enabled edges that may be false. */
std::vector<std::size_t> closuresOf(const IndexedGraph& graph);

/** From the order of the report to that of IndexedGraph; empty: 1 of each edge that is enabled.
 * Throws std::invalid_argument if their number is wrong or one is not from 0 to 1. */
std::vector<double> weightsInOrder(const IndexedGraph& graph, const std::vector<double>& weights);

/** What of a vertex the optimiser leaves as it is. */
enum class Hold
{
    Nothing,
    PositionAndYaw,
    All
};

/** The connected parts of a graph, and what is held in them. */
struct Gauge
{
    std::vector<int> first;   // by vertex: that of lowest id in its part
    std::vector<Hold> hold;   // by vertex
    std::vector<bool> free;   // by vertex, of its part: no vertex there is fixed
    std::vector<bool> tilts;  // by vertex, of its part: some gravity edge pulls there
};

/** `weights` are those of graph.relative_edges, in its order: without weight an edge connects
 * nothing. */
Gauge findGauge(
    const IndexedGraph& graph, const std::vector<Pose>& poses, const std::vector<double>& weights);

/** Moves each part that has no fixed vertex, as a rigid body and at no cost, so that what is held
 * is as it was in `before`, whichever way the optimiser took. */
void restoreGauge(const Gauge& gauge, const std::vector<Pose>& before, std::vector<Pose>& poses);

/** Basis (6 x n, n = 0, 2 or 6) of the tangent (p, theta) in which the vertex may move. */
using TangentBasis = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
TangentBasis freeDirections(Hold hold, const Matrix3d& R_world_submap);

/** Covariance of T_from_to in the tangent of RelativeEdge, from that of both vertices. */
Matrix6d relativeCovariance(
    const Eigen::Matrix<double, 12, 12>& joint, const Pose& T_world_from, const Pose& T_world_to);
}  // namespace taut
