#pragma once

#include <random>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/files/MeshFile.h"

namespace taut::test
{
using Points = std::vector<Eigen::Vector3f>;

/** A rectangle as two triangles, its corner and two sides. */
inline void addRectangle(
    TriangleMesh& mesh, const Vector3d& corner, const Vector3d& a, const Vector3d& b)
{
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vector3d& v :
         {corner, Vector3d(corner + a), Vector3d(corner + a + b), Vector3d(corner + b)})
        mesh.vertices.push_back(v);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

/** Points of a rectangle, about `spacing` apart, in the middle of equal cells. */
inline void addLattice(
    Points& points, const Vector3d& corner, const Vector3d& a, const Vector3d& b, double spacing)
{
    const int n = static_cast<int>(std::lround(a.norm() / spacing));
    const int m = static_cast<int>(std::lround(b.norm() / spacing));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < m; k++)
            points.push_back((corner + (i + 0.5) / n * a + (k + 0.5) / m * b).cast<float>());
}

/** A box: its three faces at the origin, then those opposite. */
struct Face
{
    Vector3d corner, a, b;
};
inline std::vector<Face> facesOfBox(const Vector3d& size)
{
    std::vector<Face> faces;
    for (const double end : {0.0, 1.0})
        for (int i = 0; i < 3; i++)
            faces.push_back(
                {end * size[i] * Vector3d::Unit(i), size[(i + 1) % 3] * Vector3d::Unit((i + 1) % 3),
                 size[(i + 2) % 3] * Vector3d::Unit((i + 2) % 3)});
    return faces;
}

inline TriangleMesh boxMesh(const Vector3d& size)
{
    TriangleMesh mesh;
    for (const Face& f : facesOfBox(size)) addRectangle(mesh, f.corner, f.a, f.b);
    return mesh;
}

inline Points boxPoints(const Vector3d& size, double spacing)
{
    Points points;
    for (const Face& f : facesOfBox(size)) addLattice(points, f.corner, f.a, f.b, spacing);
    return points;
}

/** Points of the square [0, side]^2, drawn at random, off the plane z = 0 by white noise. */
inline Points noisyPlane(double side, std::size_t count, double sigma)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0, side);
    std::normal_distribution<double> noise(0, 1);
    Points points;
    for (std::size_t i = 0; i < count; i++)
    {
        const double x = place(random), y = place(random);
        points.push_back(Vector3d(x, y, sigma * noise(random)).cast<float>());
    }
    return points;
}

inline Points moved(const Pose& T, const Points& points)
{
    Points out;
    for (const Eigen::Vector3f& p : points) out.push_back((T * p.cast<double>()).cast<float>());
    return out;
}
}  // namespace taut::test
