#include "SurfaceFit.h"

#include <algorithm>
#include <cmath>

namespace taut
{
SurfaceFit::SurfaceFit(const Vector3d* points, std::size_t count) : points_(points), count_(count)
{
    for (std::size_t i = 0; i < count; i++) mean_ += points[i];
    mean_ /= static_cast<double>(count);
    Matrix3d scatter = Matrix3d::Zero();
    for (std::size_t i = 0; i < count; i++)
    {
        const Vector3d d = points[i] - mean_;
        scatter += d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(scatter / static_cast<double>(count));
    variances_ = solver.eigenvalues().cwiseMax(0);
    axes_ = solver.eigenvectors();
}

double SurfaceFit::leverage(const Vector3d& query, int first_axis) const
{
    double sum = 1;
    for (int i = first_axis; i < 3; i++)
    {
        const double along = axes_.col(i).dot(query - mean_);
        sum += along * along / variances_[i];
    }
    return std::sqrt(sum / static_cast<double>(count_));
}

Correspondence SurfaceFit::line(const Vector3d& query, double ratio, double tolerance) const
{
    const Vector3d direction = axes_.col(2);
    if (!(variances_[2] > 0) || variances_[2] < ratio * variances_[1]) return {};
    for (std::size_t i = 0; i < count_; i++)
        if (direction.cross(points_[i] - mean_).norm() > tolerance) return {};
    const auto n = static_cast<double>(count_);
    const double thickness =
        std::sqrt((variances_[0] + variances_[1]) / 2 * n / std::max(n - 2, 1.0));
    return {Surface::Line, direction, mean_, thickness * leverage(query, 2)};
}

Correspondence SurfaceFit::plane(const Vector3d& query, double min_spread, double tolerance) const
{
    const Vector3d normal = axes_.col(0);
    if (variances_[1] < min_spread * min_spread) return {};
    for (std::size_t i = 0; i < count_; i++)
        if (std::abs(normal.dot(points_[i] - mean_)) > tolerance) return {};
    const auto n = static_cast<double>(count_);
    const double thickness = std::sqrt(variances_[0] * n / std::max(n - 3, 1.0));
    return {Surface::Plane, normal, mean_, thickness * leverage(query, 1)};
}
}  // namespace taut
