#include "Objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace taut
{
namespace
{
constexpr int kSlices = 12;

mrpt::math::TPoint3Df toMrpt(const Vector3d& p)
{
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/** Two unit vectors at right angles to a unit vector and to each other. */
std::array<Vector3d, 2> across(const Vector3d& axis)
{
    const Vector3d other =
        std::abs(axis.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d(Vector3d::UnitX());
    const Vector3d u = axis.cross(other).normalized();
    return {u, axis.cross(u)};
}

struct Corner
{
    Vector3d position, normal;
};

void addTriangle(
    mrpt::opengl::CSetOfTriangles& triangles, const std::array<Corner, 3>& corners,
    const Rgb& color)
{
    mrpt::opengl::TTriangle t;
    for (std::size_t i = 0; i < 3; ++i)
    {
        t.vertices[i].xyzrgba.pt = toMrpt(corners[i].position);
        const auto n = toMrpt(corners[i].normal);
        t.vertices[i].normal = {n.x, n.y, n.z};
    }
    t.setColor(mrpt::img::TColor(color[0], color[1], color[2]));
    triangles.insertTriangle(t);
}

void addQuad(
    mrpt::opengl::CSetOfTriangles& triangles, const std::array<Corner, 4>& c, const Rgb& color)
{
    addTriangle(triangles, {c[0], c[1], c[2]}, color);
    addTriangle(triangles, {c[0], c[2], c[3]}, color);
}
}  // namespace

std::vector<mrpt::opengl::CPointCloudColoured::Ptr> makeClouds(
    const PointCloud& points, const Span& heights, const ViewCamera& camera, double dot_size,
    int supersampling)
{
    std::map<int, mrpt::opengl::CPointCloudColoured::Ptr> clouds;  // by size in pixels
    const double least = 1.5 * supersampling, most = 8 * supersampling;
    const double range = std::max(heights.size(), 1e-3);
    for (const auto& p : points)
    {
        const Vector3d seen = camera.inCamera(p.cast<double>());
        const double pixel = camera.metresPerPixel(seen.z());
        const auto size = static_cast<int>(std::lround(std::clamp(dot_size / pixel, least, most)));
        auto& cloud = clouds[size];
        if (!cloud) cloud = mrpt::opengl::CPointCloudColoured::Create();
        const Rgb c = heightColor((static_cast<double>(p.z()) - heights.low) / range);
        const auto [x, y, z] = toMrpt(seen);
        cloud->insertPoint({x, y, z, c[0], c[1], c[2], 255});
    }
    std::vector<mrpt::opengl::CPointCloudColoured::Ptr> objects;
    for (const auto& [size, cloud] : clouds)
    {
        cloud->enableVariablePointSize(false);
        cloud->setPointSize(static_cast<float>(size));
        objects.push_back(cloud);
    }
    return objects;
}

mrpt::opengl::CSetOfLines::Ptr makeGrid(
    const Span& x, const Span& y, double z, double step, const ViewCamera& camera)
{
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(150, 158, 170);
    const auto first = [&](const Span& side) { return std::lround(side.low / step) - 1; };
    const auto last = [&](const Span& side) { return std::lround(side.high / step) + 1; };
    const auto add = [&](auto i0, auto j0, auto i1, auto j1)
    {
        const auto corner = [&](auto i, auto j) {
            return camera.inCamera(
                {static_cast<double>(i) * step, static_cast<double>(j) * step, z});
        };
        const Vector3d a = corner(i0, j0), b = corner(i1, j1);
        lines->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    };
    for (auto i = first(x); i <= last(x); ++i) add(i, first(y), i, last(y));
    for (auto j = first(y); j <= last(y); ++j) add(first(x), j, last(x), j);
    return lines;
}

Solids::Solids(const ViewCamera& camera)
    : camera_(camera), triangles_(mrpt::opengl::CSetOfTriangles::Create())
{
}

void Solids::addTube(const Vector3d& from, const Vector3d& to, double radius, const Rgb& color)
{
    const Vector3d begin = camera_.inCamera(from), end = camera_.inCamera(to);
    const Vector3d along = end - begin;
    if (along.norm() < 1e-6) return;
    const auto [u, v] = across(along.normalized());
    const auto direction = [&, u = u, v = v](int slice)
    {
        const double angle = 2 * M_PI * slice / kSlices;
        return Vector3d(std::cos(angle) * u + std::sin(angle) * v);
    };
    for (int i = 0; i < kSlices; ++i)
    {
        const Vector3d a = direction(i), b = direction(i + 1);
        addQuad(
            *triangles_,
            {Corner{begin + radius * a, a}, Corner{end + radius * a, a},
             Corner{end + radius * b, b}, Corner{begin + radius * b, b}},
            color);
    }
}

void Solids::addSphere(const Vector3d& center, double radius, const Rgb& color)
{
    constexpr int kRings = kSlices / 2;
    const Vector3d middle = camera_.inCamera(center);
    const auto corner = [&](int ring, int slice)
    {
        const double polar = M_PI * ring / kRings, angle = 2 * M_PI * slice / kSlices;
        const Vector3d n(
            std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
        return Corner{middle + radius * n, n};
    };
    for (int ring = 0; ring < kRings; ++ring)
        for (int slice = 0; slice < kSlices; ++slice)
            addQuad(
                *triangles_,
                {corner(ring, slice), corner(ring + 1, slice), corner(ring + 1, slice + 1),
                 corner(ring, slice + 1)},
                color);
}

void Solids::addPath(const std::vector<Pose>& trajectory, double radius, const Rgb& color)
{
    if (trajectory.empty()) return;
    Vector3d last = trajectory.front().p;
    addSphere(last, radius, color);
    const auto add = [&](const Vector3d& p)
    {
        addTube(last, p, radius, color);
        addSphere(p, radius, color);
        last = p;
    };
    for (const Pose& pose : trajectory)
        if ((pose.p - last).norm() >= radius) add(pose.p);
    add(trajectory.back().p);
}

void Solids::addAxes(const Pose& T_world_frame, double length, double radius)
{
    constexpr std::array<Rgb, 3> colors{Rgb{214, 39, 40}, {44, 160, 44}, {31, 90, 200}};
    for (int i = 0; i < 3; ++i)
    {
        const Vector3d tip = T_world_frame.p + length * T_world_frame.R.col(i);
        const auto& color = colors[static_cast<std::size_t>(i)];
        addTube(T_world_frame.p, tip, radius, color);
        addSphere(tip, radius, color);
    }
}
}  // namespace taut
