#pragma once

#include <cmath>

#include "numeric.h"
#include "taut/core/Renderer.h"

/** \file structures.h
 * Maps made of rectangles, with trajectories through them. */
namespace taut::test
{
/** Adds points at random on a parallelogram; density in points per square metre. */
inline void addRectangle(
    RenderScene& scene, const Vector3d& corner, const Vector3d& side1, const Vector3d& side2,
    double density, Random& random)
{
    const auto count = static_cast<int>(side1.norm() * side2.norm() * density);
    for (int i = 0; i < count; ++i)
        scene.points.push_back(
            (corner + random.uniform(0, 1) * side1 + random.uniform(0, 1) * side2).cast<float>());
}

/** Adds the four walls and the top of a box. */
inline void addBox(
    RenderScene& scene, const Vector3d& corner, const Vector3d& size, double density,
    Random& random)
{
    const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    addRectangle(scene, corner, x, z, density, random);
    addRectangle(scene, corner + y, x, z, density, random);
    addRectangle(scene, corner, y, z, density, random);
    addRectangle(scene, corner + x, y, z, density, random);
    addRectangle(scene, corner + z, x, y, density, random);
}

/** Poses along a straight line, x axis forward, every 10 cm. */
inline std::vector<Pose> straightPath(const Vector3d& from, const Vector3d& to)
{
    std::vector<Pose> path;
    const Vector3d x = (to - from).normalized();
    Pose pose;
    pose.R.col(0) = x;
    pose.R.col(1) = Vector3d::UnitZ().cross(x).normalized();
    pose.R.col(2) = x.cross(pose.R.col(1));
    const int steps = static_cast<int>((to - from).norm() / 0.1);
    for (int i = 0; i <= steps; ++i)
    {
        pose.p = from + (to - from) * i / steps;
        path.push_back(pose);
    }
    return path;
}

/** A hall of 40 x 24 x 8 m, floor at -1.2 m, with a ceiling and boxes; a loop of some 50 m. */
inline RenderScene hall(double density = 20)
{
    Random random(1);
    RenderScene scene;
    addBox(scene, {-20, -12, -1.2}, {40, 24, 8}, density, random);
    addRectangle(scene, {-20, -12, -1.2}, {40, 0, 0}, {0, 24, 0}, density, random);
    for (int i = 0; i < 6; ++i)
        addBox(scene, {-17.0 + 6 * i, i % 2 == 0 ? 7.0 : -9.0, -1.2}, {2, 2, 2}, density, random);
    for (int i = 0; i <= 450; ++i)
    {
        const double a = 2 * M_PI * i / 450;
        Pose pose;
        pose.p = {12 * std::sin(a), 5 * std::cos(a) - 5, 0.2 * std::sin(5 * a)};
        pose.R = expSO3({0, 0, -a});
        scene.trajectory.push_back(pose);
    }
    scene.caption = {"hall", "length 51.3 m, duration 45.0 s, mode iterated"};
    return scene;
}

/** A street of 200 m along x, ground at -1.7 m, with facades of 8 m and trees; driven along. */
inline RenderScene street(double density = 5)
{
    Random random(2);
    RenderScene scene;
    addRectangle(scene, {-10, -8, -1.7}, {220, 0, 0}, {0, 16, 0}, density, random);
    for (const double y : {-8.0, 8.0})
        addRectangle(scene, {-10, y, -1.7}, {220, 0, 0}, {0, 0, 8}, density, random);
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 300; ++k)
            scene.points.push_back((Vector3d(20 * i, 6, 3) + random.vector(0.8)).cast<float>());
    scene.trajectory = straightPath({0, 0, 0}, {200, 0, 0});
    scene.caption = {"street", "length 200 m, duration 40.0 s"};
    return scene;
}
}  // namespace taut::test
