#include "taut/loops/SubmapRegistration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr int kIterations = 25;
constexpr double kPointNoise = 0.02;  // [m] of a point of a submap, besides its surface's
constexpr double kShrink = 0.6;       // of the kernel's width, from one iteration to the next
constexpr double kDeviations = 3;     // width of the kernel in the end
constexpr double kSmallStep = 3e-4;   // [m], and of rotations at the lever: it has converged
constexpr double kLastStep = 1e-2;    // the same after the last iteration: matches may alternate

double sigmaOf(const Correspondence& c)
{
    return std::hypot(c.sigma, kPointNoise);
}
}  // namespace

std::vector<MapPoint> mapPointsOf(const Submap& submap, std::size_t most)
{
    const std::size_t n = submap.points.size();
    const std::size_t count = std::min(n, most);
    std::vector<MapPoint> points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; i++)
    {
        const SubmapPoint& p = submap.points[i * n / count];
        const Vector3d position = p.position.cast<double>();
        const Vector3d seen_from = submap.scans[p.scan].T_submap_imu.p;
        points.push_back({position, FeatureKind::Any, (seen_from - position).normalized()});
    }
    return points;
}

Extent extentOf(const std::vector<MapPoint>& points)
{
    Extent extent;
    const double share = 1 / static_cast<double>(points.size());
    for (const MapPoint& p : points) extent.middle += share * p.position;
    double spread2 = 0;
    for (const MapPoint& p : points) spread2 += share * (p.position - extent.middle).squaredNorm();
    extent.lever = std::max(1.0, std::sqrt(spread2));
    return extent;
}

PoseDirections directionsOf(const Matrix6d& hessian, const Extent& extent)
{
    PoseDirections d;
    d.lever = extent.lever;
    Matrix6d to_origin = Matrix6d::Identity();  // of an error told at the middle, scaled
    to_origin.topRightCorner<3, 3>() = hat(extent.middle) / d.lever;
    to_origin.bottomRightCorner<3, 3>() /= d.lever;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
        to_origin.transpose() * hessian * to_origin);
    d.shown = eigen.eigenvalues();
    d.axes = eigen.eigenvectors();
    d.basis = to_origin * d.axes;
    return d;
}

PointResidual planeResidual(const Pose& T, const Vector3d& x, const Correspondence& plane)
{
    PointResidual r;
    r.residual = plane.direction.dot(T * x - plane.point);
    const Vector3d n = T.R.transpose() * plane.direction;
    r.derivative << n, x.cross(n);
    return r;
}

void SubmapRegistration::match(const std::vector<MapPoint>& points, const Pose& T)
{
    queries_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); i++)
        queries_[i] = {T * points[i].position, points[i].kind, T.R * points[i].view};
    map_.match(queries_, found_, scratch_, executor_);
}

SubmapFit SubmapRegistration::align(
    const std::vector<MapPoint>& points, const Pose& guess, double width)
{
    SubmapFit fit;
    fit.T_from_to = guess;
    const Extent extent = extentOf(points);
    for (int i = 0; i < kIterations; i++)
    {
        match(points, fit.T_from_to);
        Vector6d gradient = Vector6d::Zero();
        fit.hessian.setZero();
        fit.matched = 0;
        fit.weight = 0;
        double square_sum = 0;
        for (std::size_t j = 0; j < points.size(); j++)
        {
            const Correspondence& c = found_[j];
            if (c.surface != Surface::Plane) continue;
            const PointResidual r = planeResidual(fit.T_from_to, points[j].position, c);
            const double sigma = sigmaOf(c);
            const double scale = std::max(kDeviations * sigma, width);
            const double weight = square(1 / (1 + square(r.residual / scale)));
            const double information = weight / square(sigma);
            fit.hessian += information * r.derivative * r.derivative.transpose();
            gradient += information * r.residual * r.derivative;
            square_sum += weight * square(r.residual);
            fit.weight += weight;
            fit.matched++;
        }
        if (fit.weight < 6) return fit;
        fit.residual = std::sqrt(square_sum / fit.weight);
        const PoseDirections directions = directionsOf(fit.hessian, extent);
        const Vector6d along = directions.basis.transpose() * gradient;
        Vector6d coordinates;  // open directions stay where they are
        for (int k = 0; k < 6; k++)
            coordinates[k] = directions.isOpen(k) ? 0 : -along[k] / directions.shown[k];
        const Vector6d step = directions.basis * coordinates;
        if (!step.allFinite()) return fit;
        fit.T_from_to = fit.T_from_to * Pose{expSO3(step.tail<3>()), step.head<3>()};
        const bool is_narrow = width < kDeviations * kPointNoise;
        const double moved = std::max(step.head<3>().norm(), extent.lever * step.tail<3>().norm());
        fit.converged = is_narrow && moved < kLastStep;
        if (is_narrow && moved < kSmallStep) break;
        width *= kShrink;
    }
    fit.T_from_to.R = normalizedRotation(fit.T_from_to.R);
    return fit;
}

double SubmapRegistration::inlierWeight(
    const std::vector<MapPoint>& points, const Pose& T_from_to, double width)
{
    match(points, T_from_to);
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); i++)
        if (found_[i].surface == Surface::Plane)
            sum +=
                1 /
                (1 +
                 square(planeResidual(T_from_to, points[i].position, found_[i]).residual / width));
    return sum;
}

std::vector<Vector3d> SubmapRegistration::normalsOf(const std::vector<MapPoint>& points_of_from)
{
    match(points_of_from, {});
    std::vector<Vector3d> normals(points_of_from.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < normals.size(); i++)
        if (found_[i].surface == Surface::Plane) normals[i] = found_[i].direction;
    return normals;
}

std::vector<bool> SubmapRegistration::onSurface(
    const std::vector<MapPoint>& points, const Pose& T_from_to)
{
    match(points, T_from_to);
    std::vector<bool> on(points.size(), false);
    for (std::size_t i = 0; i < points.size(); i++)
    {
        const Correspondence& c = found_[i];
        if (c.surface != Surface::Plane) continue;
        const double r = planeResidual(T_from_to, points[i].position, c).residual;
        on[i] = std::abs(r) < kDeviations * sigmaOf(c);
    }
    return on;
}
}  // namespace taut
