#pragma once

#include "IndexedGraph.h"
#include "RobustWeights.h"
#include "taut/core/GraphOptimizer.h"

namespace taut
{
/** GraphOptimizer::optimize() around a Problem that is made of the graph and its configuration:
 * checks, the schedule of the weights, the report, and the poses back into the graph. */
template <class Problem, class Config>
GraphReport optimizeBy(const Config& config, PoseGraph& graph)
{
    const IndexedGraph indexed(graph);
    Problem problem(indexed, config);
    std::vector<double> weights = startingWeights(indexed);
    GraphReport report;
    report.initial_cost = problem.cost(weights);
    report.converged = minimizeRobustly(problem, closuresOf(indexed), config.closures, weights);
    problem.finish(weights);
    report.final_cost = problem.cost(weights);
    report.iterations = problem.iterations();

    report.relative_chi2.resize(weights.size());
    report.weights.resize(weights.size());
    report.gravity_chi2.resize(graph.gravity_edges.size());
    for (std::size_t e = 0; e < weights.size(); e++)
    {
        const std::size_t position = indexed.relative_edges[e].position;
        report.relative_chi2[position] = problem.chi2(e);
        report.weights[position] = weights[e];
    }
    for (std::size_t e = 0; e < indexed.gravity_edges.size(); e++)
        report.gravity_chi2[indexed.gravity_edges[e].position] = problem.gravityChi2(e);
    const std::vector<Pose> poses = problem.poses();
    for (std::size_t v = 0; v < poses.size(); v++)
        if (!indexed.vertices[v]->fixed)
            graph.vertices[indexed.positions[v]].T_world_submap = poses[v];
    return report;
}
}  // namespace taut
