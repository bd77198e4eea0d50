#pragma once

#include "taut/core/PoseGraph.h"

/** \file GraphResiduals.h
 * Residuals of the edges of a pose graph with analytic Jacobians. A pose is perturbed by (p,
 * theta): p <- p + dp in the world, R <- R Exp(dtheta). */
namespace taut
{
/** The pose moved by (dp, dtheta). */
Pose perturbed(const Pose& T, const Vector6d& delta);

/** r = [R_z^T (R_i^T (p_j - p_i) - p_z); Log(R_z^T R_i^T R_j)] with z the measurement T_from_to. */
Vector6d relativeResidual(const Pose& T_from_to, const Pose& T_world_from, const Pose& T_world_to);

struct RelativeLinearization
{
    Vector6d residual;
    Matrix6d by_from, by_to;
};
RelativeLinearization linearizeRelative(
    const Pose& T_from_to, const Pose& T_world_from, const Pose& T_world_to);

/** The rotation vector, told in the submap's frame and perpendicular to both directions, by which
 * the submap is turned too far: zero where R^T e_z is the measured up; its norm is the angle. */
Vector3d gravityResidual(const Vector3d& up_submap, const Matrix3d& R_world_submap);

struct GravityLinearization
{
    Vector3d residual;
    Matrix3d by_rotation;
};
GravityLinearization linearizeGravity(const Vector3d& up_submap, const Matrix3d& R_world_submap);
}  // namespace taut
