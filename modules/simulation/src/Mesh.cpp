#include "taut/simulation/Mesh.h"

#include <algorithm>
#include <cmath>

namespace taut::simulation
{
namespace
{
std::uint32_t addVertex(Mesh& mesh, const Vector3d& v)
{
    mesh.vertices.push_back(v);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void addTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, float reflectivity)
{
    mesh.triangles.push_back({a, b, c});
    mesh.reflectivity.push_back(reflectivity);
}
}  // namespace

void Mesh::append(const Mesh& other, const Pose& T)
{
    const auto shift = static_cast<std::uint32_t>(vertices.size());
    for (const Vector3d& v : other.vertices) vertices.push_back(T * v);
    for (const Triangle& t : other.triangles)
        triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    reflectivity.insert(reflectivity.end(), other.reflectivity.begin(), other.reflectivity.end());
}

void addQuad(
    Mesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
    float reflectivity)
{
    const auto ia = addVertex(mesh, a), ib = addVertex(mesh, b);
    const auto ic = addVertex(mesh, c), id = addVertex(mesh, d);
    addTriangle(mesh, ia, ib, ic, reflectivity);
    addTriangle(mesh, ia, ic, id, reflectivity);
}

void addBox(Mesh& mesh, const Pose& T, const Vector3d& size, float reflectivity)
{
    const Vector3d h = size / 2;
    const auto corner = [&](int x, int y, int z)
    { return T * Vector3d(x * h.x(), y * h.y(), z * h.z()); };
    for (const int s : {-1, 1})
    {
        addQuad(
            mesh, corner(s, -1, -1), corner(s, 1, -1), corner(s, 1, 1), corner(s, -1, 1),
            reflectivity);
        addQuad(
            mesh, corner(-1, s, -1), corner(1, s, -1), corner(1, s, 1), corner(-1, s, 1),
            reflectivity);
        addQuad(
            mesh, corner(-1, -1, s), corner(1, -1, s), corner(1, 1, s), corner(-1, 1, s),
            reflectivity);
    }
}

void addStandingBox(
    Mesh& mesh, const Vector3d& base, const Vector3d& size, double yaw, float reflectivity)
{
    const Pose T{expSO3(Vector3d(0, 0, yaw)), base + Vector3d(0, 0, size.z() / 2)};
    addBox(mesh, T, size, reflectivity);
}

void addFrustum(
    Mesh& mesh, const Vector3d& bottom, const Vector3d& top, double radius_bottom,
    double radius_top, int sides, float reflectivity)
{
    const Vector3d axis = (top - bottom).normalized();
    const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
    const auto bottom_center = addVertex(mesh, bottom), top_center = addVertex(mesh, top);
    const auto ring = top_center + 1;
    for (int i = 0; i < sides; i++)
    {
        const double angle = 2 * M_PI * i / sides;
        const Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
        addVertex(mesh, bottom + radius_bottom * out);
        addVertex(mesh, top + radius_top * out);
    }
    for (int i = 0; i < sides; i++)
    {
        const auto a = ring + static_cast<std::uint32_t>(2 * i);
        const auto b = ring + static_cast<std::uint32_t>(2 * ((i + 1) % sides));
        addTriangle(mesh, a, b, b + 1, reflectivity);
        addTriangle(mesh, a, b + 1, a + 1, reflectivity);
        addTriangle(mesh, bottom_center, b, a, reflectivity);
        addTriangle(mesh, top_center, a + 1, b + 1, reflectivity);
    }
}

void addGround(
    Mesh& mesh, double min_x, double min_y, double max_x, double max_y, double cell,
    const std::function<double(double, double)>& height, float reflectivity)
{
    const int nx = std::max(1, static_cast<int>(std::ceil((max_x - min_x) / cell)));
    const int ny = std::max(1, static_cast<int>(std::ceil((max_y - min_y) / cell)));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++)
        {
            const double x = min_x + (max_x - min_x) * i / nx;
            const double y = min_y + (max_y - min_y) * j / ny;
            addVertex(mesh, {x, y, height(x, y)});
        }
    const auto row = static_cast<std::uint32_t>(nx + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(ny); j++)
        for (std::uint32_t i = 0; i + 1 < row; i++)
        {
            const std::uint32_t a = first + j * row + i;
            addTriangle(mesh, a, a + 1, a + row + 1, reflectivity);
            addTriangle(mesh, a, a + row + 1, a + row, reflectivity);
        }
}

void addRoom(Mesh& mesh, const Vector3d& min, const Vector3d& max, float reflectivity)
{
    addBox(mesh, {Matrix3d::Identity(), (min + max) / 2}, max - min, reflectivity);
}
}  // namespace taut::simulation
