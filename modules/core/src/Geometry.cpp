#include "taut/core/Geometry.h"

#include <cmath>

namespace taut
{
namespace
{
// Below this angle (0.03 rad) the series of three terms are exact to double precision.
constexpr double kSmallAngleSquared = 1e-3;
}  // namespace

Matrix3d hat(const Vector3d& v)
{
    Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Matrix3d expSO3(const Vector3d& phi)
{
    const double theta2 = phi.squaredNorm();
    double a, b;  // Exp = I + a hat + b hat^2
    if (theta2 < kSmallAngleSquared)
    {
        a = 1 - theta2 / 6 * (1 - theta2 / 20 * (1 - theta2 / 42));
        b = 0.5 - theta2 / 24 * (1 - theta2 / 30 * (1 - theta2 / 56));
    }
    else
    {
        const double theta = std::sqrt(theta2);
        const double half_sine = std::sin(theta / 2);
        a = std::sin(theta) / theta;
        b = 2 * half_sine * half_sine / theta2;
    }
    const Matrix3d h = hat(phi);
    return Matrix3d::Identity() + a * h + b * h * h;
}

Vector3d logSO3(const Matrix3d& R)
{
    const Vector3d vee(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));  // 2 sin axis
    const double cosine2 = R.trace() - 1;                                         // 2 cos
    const double sine2 = vee.norm();
    if (cosine2 < -1.9)  // near pi the sine says nothing of the axis: take the quaternion
    {
        Eigen::Quaterniond q(R);
        q.normalize();
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        const double n = q.vec().norm();
        return q.vec() * (2 * std::atan2(n, q.w()) / n);
    }
    const double theta = std::atan2(sine2, cosine2);
    // theta / (2 sin theta); its series below
    const double k = sine2 < 1e-4 ? 0.5 + theta * theta / 12 : theta / sine2;
    return k * vee;
}

Matrix3d rightJacobianSO3(const Vector3d& phi)
{
    const double theta2 = phi.squaredNorm();
    double a, b;  // Jr = I - a hat + b hat^2
    if (theta2 < kSmallAngleSquared)
    {
        a = 0.5 - theta2 / 24 * (1 - theta2 / 30 * (1 - theta2 / 56));
        b = 1.0 / 6 - theta2 / 120 * (1 - theta2 / 42 * (1 - theta2 / 72));
    }
    else
    {
        const double theta = std::sqrt(theta2);
        const double half_sine = std::sin(theta / 2);
        a = 2 * half_sine * half_sine / theta2;
        b = (theta - std::sin(theta)) / (theta2 * theta);
    }
    const Matrix3d h = hat(phi);
    return Matrix3d::Identity() - a * h + b * h * h;
}

Matrix3d inverseRightJacobianSO3(const Vector3d& phi)
{
    const double theta2 = phi.squaredNorm();
    double b;  // Jr^-1 = I + 1/2 hat + b hat^2
    if (theta2 < 1e-6)
    {
        b = 1.0 / 12 + theta2 / 720;
    }
    else
    {
        const double half = std::sqrt(theta2) / 2;
        b = (1 - half / std::tan(half)) / theta2;
    }
    const Matrix3d h = hat(phi);
    return Matrix3d::Identity() + 0.5 * h + b * h * h;
}

Matrix3d normalizedRotation(const Matrix3d& R)
{
    return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}
}  // namespace taut
