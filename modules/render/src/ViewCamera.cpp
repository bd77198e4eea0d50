#include "taut/render/ViewCamera.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kMargin = 0.05;         // free share of the picture on each side
constexpr double kSmallestExtent = 2.0;  // [m] a lone point is not magnified beyond this
constexpr double kDegree = M_PI / 180;

/** Camera axes that look along `forward` with the horizon level; straight down, `up` is up. */
Matrix3d lookAlong(const Vector3d& forward, const Vector3d& up)
{
    Matrix3d R;
    R.col(2) = forward.normalized();
    R.col(0) = R.col(2).cross(up).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return R;
}

double middle(const Span& span)
{
    return (span.low + span.high) / 2;
}

ViewCamera topCamera(const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size)
{
    const Span x = extentAlong(points, trajectory, Vector3d::UnitX());
    const Span y = extentAlong(points, trajectory, Vector3d::UnitY());
    const double dx = std::max(x.size(), kSmallestExtent);
    const double dy = std::max(y.size(), kSmallestExtent);
    const double free = 1 - 2 * kMargin;
    const double upright = free * std::min(size.width / dx, size.height / dy);
    const double turned = free * std::min(size.width / dy, size.height / dx);
    const bool turn = turned > 1.2 * upright;

    ViewCamera camera;
    camera.size = size;
    camera.orthographic = true;
    camera.scale = turn ? turned : upright;
    camera.T_world_camera.R =
        lookAlong(-Vector3d::UnitZ(), turn ? Vector3d::UnitX() : Vector3d::UnitY());
    const Span z = extentAlong(points, trajectory, Vector3d::UnitZ());
    const double height = 2 * z.size() + 20;  // leaves room for what sticks out of the span
    camera.T_world_camera.p = {middle(x), middle(y), z.high + height};
    camera.near_depth = 0.1 * height;
    camera.far_depth = 2 * height;
    camera.focus_depth = height;
    return camera;
}

/** Direction of the longest extent of the ground plan [rad]. */
double principalAzimuth(const PointCloud& points, const std::vector<Pose>& trajectory)
{
    std::vector<Eigen::Vector2d> ground;
    for (const auto& p : points) ground.emplace_back(p.head<2>().cast<double>());
    if (ground.empty())
        for (const Pose& pose : trajectory) ground.emplace_back(pose.p.head<2>());
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& g : ground) mean += g / static_cast<double>(ground.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const auto& g : ground) scatter += (g - mean) * (g - mean).transpose();
    return 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
}

/** Places the camera, whose axes are given, as near as it can be with everything in sight. A point
 * with coordinates (a, b, d) along the camera's axes is in sight of a camera at (ca, cb, cd) where
 * |a - ca| <= t (d - cd), and likewise for b: bounds that are linear in the camera's place. */
ViewCamera fittedCamera(
    const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size,
    const Matrix3d& R, double half_angle)
{
    ViewCamera camera;
    camera.size = size;
    camera.T_world_camera.R = R;
    camera.scale = size.height / 2.0 / std::tan(half_angle);
    const Vector3d forward = R.col(2);
    const Span depth = extentAlong(points, trajectory, forward);
    Vector3d place;  // along the camera's axes
    place.z() = depth.low;
    for (int i = 0; i < 2; ++i)
    {
        const int pixels = i == 0 ? size.width : size.height;
        const double t = (1 - 2 * kMargin) * pixels / 2.0 / camera.scale;
        const double low = extentAlong(points, trajectory, R.col(i) - t * forward).high;
        const double high = extentAlong(points, trajectory, R.col(i) + t * forward).low;
        place[i] = (low + high) / 2;
        place.z() = std::min(place.z(), (high - low) / (2 * t));
    }
    place.z() = std::min(place.z(), middle(depth) - kSmallestExtent / std::tan(half_angle));
    camera.T_world_camera.p = R * place;
    camera.focus_depth = middle(depth) - place.z();
    camera.near_depth = 0.2 * camera.focus_depth;
    camera.far_depth = 3 * std::max(camera.focus_depth, depth.high - place.z());
    return camera;
}

ViewCamera obliqueCamera(
    const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size)
{
    constexpr double kElevation = 42 * kDegree, kFromTheSide = 28 * kDegree;
    constexpr double kHalfAngle = 15 * kDegree;
    // The longer side of the map lies across the picture, seen from a corner.
    double azimuth = principalAzimuth(points, trajectory) + M_PI / 2 + kFromTheSide;
    if (std::sin(azimuth) < 0) azimuth += M_PI;
    const Vector3d forward(
        std::cos(azimuth) * std::cos(kElevation), std::sin(azimuth) * std::cos(kElevation),
        -std::sin(kElevation));
    return fittedCamera(
        points, trajectory, size, lookAlong(forward, Vector3d::UnitZ()), kHalfAngle);
}

/** Horizontal direction in which the body moved over the last `distance` metres; where it hardly
 * did, the direction of its x axis. */
Vector3d headingAtEnd(const std::vector<Pose>& trajectory, double distance)
{
    const Vector3d end = trajectory.back().p;
    Vector3d moved = Vector3d::Zero();
    double path = 0;
    for (std::size_t i = trajectory.size() - 1; i > 0 && path < distance; --i)
    {
        path += (trajectory[i].p - trajectory[i - 1].p).norm();
        moved = end - trajectory[i - 1].p;
    }
    moved.z() = 0;
    if (moved.norm() < 0.2 * distance) moved = trajectory.back().R.col(0);
    moved.z() = 0;
    return moved.norm() < 1e-3 ? Vector3d::UnitX() : moved.normalized();
}

ViewCamera followCamera(
    const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size)
{
    constexpr double kHalfAngle = 27 * kDegree;
    const double extent = std::max(
        extentAlong(points, trajectory, Vector3d::UnitX()).size(),
        extentAlong(points, trajectory, Vector3d::UnitY()).size());
    const double distance = std::clamp(0.25 * extent, 3.0, 18.0);
    const Vector3d heading = headingAtEnd(trajectory, distance);
    const Vector3d body = trajectory.back().p;

    ViewCamera camera;
    camera.size = size;
    camera.T_world_camera.p = body - distance * heading + 0.7 * distance * Vector3d::UnitZ();
    const Vector3d target = body + 0.4 * distance * heading;
    camera.T_world_camera.R = lookAlong(target - camera.T_world_camera.p, Vector3d::UnitZ());
    camera.scale = size.height / 2.0 / std::tan(kHalfAngle);
    camera.focus_depth = camera.project(body).z();
    camera.near_depth = 0.6 * distance;  // the floor in sight is farther away
    camera.far_depth = 20 * distance;
    return camera;
}
}  // namespace

Span extentAlong(
    const PointCloud& points, const std::vector<Pose>& trajectory, const Vector3d& axis)
{
    const double any =
        axis.dot(points.empty() ? trajectory.front().p : Vector3d(points.front().cast<double>()));
    Span span{any, any};
    const auto extend = [&](const Vector3d& p)
    {
        span.low = std::min(span.low, axis.dot(p));
        span.high = std::max(span.high, axis.dot(p));
    };
    for (const auto& p : points) extend(p.cast<double>());
    for (const Pose& pose : trajectory) extend(pose.p);
    return span;
}

Vector3d ViewCamera::project(const Vector3d& p_world) const
{
    const Vector3d p = inCamera(p_world);
    const double pixels_per_metre = 1 / metresPerPixel(p.z());
    return {
        size.width / 2.0 + p.x() * pixels_per_metre, size.height / 2.0 + p.y() * pixels_per_metre,
        p.z()};
}

bool ViewCamera::sees(const Vector3d& p_world) const
{
    const Vector3d p = project(p_world);
    return p.z() > near_depth && p.z() < far_depth && p.x() >= 0 && p.y() >= 0 &&
           p.x() < size.width && p.y() < size.height;
}

ViewCamera makeCamera(
    View view, const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size)
{
    switch (view)
    {
        case View::Top:
            return topCamera(points, trajectory, size);
        case View::Oblique:
            return obliqueCamera(points, trajectory, size);
        case View::Follow:
            break;
    }
    return followCamera(points, trajectory, size);
}
}  // namespace taut
