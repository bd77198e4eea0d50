#pragma once

#include <mrpt/rtti/CObject.h>

#include <memory>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/PoseGraph.h"

namespace taut
{
struct GraphReport
{
    /** 1/2 sum w r^T Omega r over all edges; initially with w = 1 for every enabled one. */
    double initial_cost = 0, final_cost = 0;
    /** r^T Omega r at the result, without the weight, in the order of the graph's edges. Edges that
     * are not enabled have theirs too. */
    std::vector<double> relative_chi2, gravity_chi2;
    /** Of each relative edge: 1 where believed, 0 where refused or not enabled. Odometry has 1. */
    std::vector<double> weights;
    int iterations = 0;  //!< linear systems solved
    bool converged = false;
};

/** How uncertain the poses of a graph are: blocks of the inverse of its Hessian. The tangent of a
 * vertex has the order (p, theta): position in the world frame, rotation on the right. Unknown ids
 * throw std::invalid_argument. */
class GraphCovariance
{
 public:
    using Matrix12d = Eigen::Matrix<double, 12, 12>;

    virtual ~GraphCovariance() = default;

    /** Of (first, second). Zero where a vertex, or a direction of it, is held. */
    virtual Matrix12d joint(VertexId first, VertexId second) const = 0;

    /** Of one vertex, relative to what is held in its part of the graph. */
    virtual Matrix6d marginal(VertexId id) const = 0;

    /** Of T_from_to in the tangent that RelativeEdge uses: its inverse is the information of an
     * edge. Throws std::invalid_argument if nothing connects the two. */
    virtual Matrix6d relative(VertexId from, VertexId to) const = 0;
};

/** Plug point: moves the vertices of a pose graph to where its edges have the least cost.
 *
 * What is held: the fixed vertices. A connected part of the graph without one keeps the position of
 * its vertex of lowest id, and its rotation: all of it, or, where gravity edges tell roll and
 * pitch, the yaw. (The turn from the old to the new rotation has no twist about the world's z.)
 *
 * std::invalid_argument, naming the edge or vertex, tells of: an id that is unknown or given twice;
 * an edge from a vertex to itself; a number that is not finite; a matrix that is no rotation; an
 * `up_submap` that is no unit vector; an information that is not symmetric or not positive
 * semi-definite. The graph is as before then. */
class GraphOptimizer : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(GraphOptimizer)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** The same input gives the same bits. */
    virtual GraphReport optimize(PoseGraph& graph) const = 0;

    /** At the present poses. `weights` are those of the report; empty: every enabled edge has 1.
     * Throws std::runtime_error where the edges leave a direction open that is not held. */
    virtual std::shared_ptr<const GraphCovariance> covariance(
        const PoseGraph& graph, const std::vector<double>& weights) const = 0;
};
}  // namespace taut
