#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/** \file Geometry.h
 * SO(3) and rigid transformations. Rotations are perturbed on the right, R <- R Exp(dtheta);
 * quaternions are Hamilton; `T_a_b` maps points of frame b to frame a. */
namespace taut
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

inline double square(double x)
{
    return x * x;
}

/** The skew-symmetric matrix of v: hat(v) w = v x w. */
Matrix3d hat(const Vector3d& v);

/** Rotation matrix of a rotation vector [rad]. */
Matrix3d expSO3(const Vector3d& phi);

/** Rotation vector [rad], of norm at most pi, of a rotation matrix. */
Vector3d logSO3(const Matrix3d& R);

/** Right Jacobian: Exp(phi + d) = Exp(phi) Exp(Jr(phi) d) to first order. */
Matrix3d rightJacobianSO3(const Vector3d& phi);

/** Inverse of the right Jacobian: Log(Exp(phi) Exp(d)) = phi + Jr^-1(phi) d to first order. */
Matrix3d inverseRightJacobianSO3(const Vector3d& phi);

/** The closest rotation matrix: takes the drift of long products away. */
Matrix3d normalizedRotation(const Matrix3d& R);

/** A rigid transformation T_a_b: p_a = R p_b + p. */
struct Pose
{
    Matrix3d R = Matrix3d::Identity();
    Vector3d p = Vector3d::Zero();  //!< [m]

    Vector3d operator*(const Vector3d& point) const { return R * point + p; }
    Pose operator*(const Pose& other) const { return {R * other.R, R * other.p + p}; }
    Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};
}  // namespace taut
