#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "taut/core/Geometry.h"

/** \file PoseGraph.h
 * Submaps and what is known of where they are to each other. The world's z axis points up. */
namespace taut
{
using VertexId = std::int64_t;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/** From an error on the left of a pose to the same one on its right: Exp(d) T = T Exp(d') with
 * d' = rightFromLeft(T) d to first order, where d = (p, theta), Exp(d) T = {Exp(theta) R,
 * Exp(theta) t
 * + p} and T Exp(d') = {R Exp(theta'), R p' + t}. */
Matrix6d rightFromLeft(const Pose& T);

/** The error d' = (p, theta) with T Exp(d') = other, as above. */
Vector6d rightErrorTo(const Pose& T, const Pose& other);

/** The directions of which an information matrix says anything, as far as rounding lets tell. */
struct ShownDirections
{
    Eigen::Matrix<double, 6, Eigen::Dynamic> basis;  //!< orthonormal columns
    Eigen::VectorXd information;                     //!< along each, ascending
};
ShownDirections shownDirections(const Matrix6d& information);

/** The pose of a submap. */
struct GraphVertex
{
    VertexId id = 0;
    Pose T_world_submap;
    bool fixed = false;  //!< the optimiser leaves it where it is
};

enum class EdgeKind
{
    Odometry,    //!< always believed
    LoopClosure  //!< may be false: a robust optimiser may give it less weight, down to none
};

/** A measured relative pose of two submaps. With the true poses its error is the tangent vector
 * d = (p, theta) [m, rad] with T_from_to Exp(d) = T_from^-1 T_to, where
 * T Exp(d) = {R Exp(theta), R p + p_T}: both parts are told in the frame of `to`. */
struct RelativeEdge
{
    VertexId from = 0, to = 0;
    Pose T_from_to;
    /** Inverse covariance of d, order (p, theta) [1/m^2, 1/(m rad), 1/rad^2]. Symmetric, positive
     * semi-definite: a direction that was not seen has none. */
    Matrix6d information = Matrix6d::Identity();
    EdgeKind kind = EdgeKind::Odometry;
    bool enabled = true;  //!< else kept for the record: it does not pull
};

/** The direction of up as a submap knows it: tells roll and pitch, never yaw. */
struct GravityEdge
{
    VertexId vertex = 0;
    Vector3d up_submap = Vector3d::UnitZ();  //!< unit vector
    /** Inverse covariance of a small rotation of the submap, told in its frame [1/rad^2]. What it
     * has along `up_submap` says nothing and has no effect. Positive semi-definite. */
    Matrix3d information = Matrix3d::Identity();
};

struct PoseGraph
{
    std::vector<GraphVertex> vertices;
    std::vector<RelativeEdge> relative_edges;
    std::vector<GravityEdge> gravity_edges;

    /** Position in `vertices`; -1 if there is none of that id. Takes time linear in their number.
     */
    std::ptrdiff_t indexOf(VertexId id) const;
};
}  // namespace taut
