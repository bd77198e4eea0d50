#include "taut/graph/GraphResiduals.h"

#include <cmath>

namespace taut
{
namespace
{
/** k = t / sin t and (dk/dt) / sin t at t = atan2(sine, cosine). */
struct AngleBySine
{
    double k, derivative;
};

AngleBySine angleBySine(double sine, double cosine)
{
    const double t = std::atan2(sine, cosine);
    if (t < 1e-3) return {1 + t * t / 6, 1.0 / 3 + 7 * t * t / 30};
    return {t / sine, (sine - t * cosine) / (sine * sine * sine)};
}

/** Upside down every axis of the horizon is as good as the other: one that is well defined. */
Vector3d anyPerpendicular(const Vector3d& v)
{
    int smallest = 0;
    v.cwiseAbs().minCoeff(&smallest);
    return v.cross(Vector3d::Unit(smallest)).normalized();
}
}  // namespace

Pose perturbed(const Pose& T, const Vector6d& delta)
{
    return {normalizedRotation(T.R * expSO3(delta.tail<3>())), T.p + delta.head<3>()};
}

Vector6d relativeResidual(const Pose& T_from_to, const Pose& T_world_from, const Pose& T_world_to)
{
    return rightErrorTo(T_from_to, T_world_from.inverse() * T_world_to);
}

RelativeLinearization linearizeRelative(
    const Pose& T_from_to, const Pose& T_world_from, const Pose& T_world_to)
{
    const Matrix3d Rz_t = T_from_to.R.transpose();
    const Matrix3d Ri_t = T_world_from.R.transpose();
    const Matrix3d R_ij = Ri_t * T_world_to.R;
    const Vector3d p_ij = Ri_t * (T_world_to.p - T_world_from.p);

    RelativeLinearization result;
    result.residual << Rz_t * (p_ij - T_from_to.p), logSO3(Rz_t * R_ij);
    const Matrix3d by_position = Rz_t * Ri_t;
    const Matrix3d by_rotation = inverseRightJacobianSO3(result.residual.tail<3>());
    result.by_from << -by_position, Rz_t * hat(p_ij), Matrix3d::Zero(),
        -by_rotation * R_ij.transpose();
    result.by_to << by_position, Matrix3d::Zero(), Matrix3d::Zero(), by_rotation;
    return result;
}

Vector3d gravityResidual(const Vector3d& up_submap, const Matrix3d& R_world_submap)
{
    const Vector3d up = R_world_submap.row(2).transpose();
    const Vector3d across = up.cross(up_submap);
    const double sine = across.norm(), cosine = up.dot(up_submap);
    if (cosine < 0 && sine < 1e-9) return EIGEN_PI * anyPerpendicular(up_submap);
    return angleBySine(sine, cosine).k * across;
}

GravityLinearization linearizeGravity(const Vector3d& up_submap, const Matrix3d& R_world_submap)
{
    const Vector3d up = R_world_submap.row(2).transpose();
    const Vector3d across = up.cross(up_submap);
    const double sine = across.norm(), cosine = up.dot(up_submap);
    GravityLinearization result;
    result.residual = gravityResidual(up_submap, R_world_submap);
    if (cosine < 0 && sine < 1e-9)
    {
        // The angle falls at rate one about the axis taken; across it the axis itself would jump.
        const Vector3d axis = result.residual.normalized();
        result.by_rotation = axis * axis.transpose();
        return result;
    }
    const auto [k, derivative] = angleBySine(sine, cosine);
    // d across = -hat(up_submap) hat(up) dtheta, and d angle = across . dtheta / sine
    result.by_rotation = -k * hat(up_submap) * hat(up) + derivative * across * across.transpose();
    return result;
}
}  // namespace taut
