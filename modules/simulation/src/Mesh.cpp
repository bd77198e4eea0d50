#include "taut/simulation/Mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "taut/files/MeshFile.h"

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

void Mesh::mark(std::size_t first, Material material)
{
    materials.resize(first, Material::Solid);
    materials.resize(triangles.size(), material);
}

void Mesh::append(const Mesh& other, const Pose& T)
{
    if (!other.materials.empty())
    {
        materials.resize(triangles.size(), Material::Solid);
        materials.insert(materials.end(), other.materials.begin(), other.materials.end());
    }
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

void addWall(
    Mesh& mesh, const Pose& T, double length, double height, const std::vector<Recess>& recesses,
    float reflectivity)
{
    // The edges of the recesses cut the wall in cells, each of which is wall or recess as a whole.
    std::vector<double> xs{0, length}, zs{0, height};
    for (const Recess& r : recesses)
    {
        xs.insert(xs.end(), {r.left, r.right});
        zs.insert(zs.end(), {r.bottom, r.top});
    }
    for (auto* cuts : {&xs, &zs})
    {
        std::sort(cuts->begin(), cuts->end());
        cuts->erase(std::unique(cuts->begin(), cuts->end()), cuts->end());
    }
    const auto at = [&T](double x, double y, double z) { return T * Vector3d(x, y, z); };
    for (std::size_t i = 0; i + 1 < xs.size(); i++)
        for (std::size_t k = 0; k + 1 < zs.size(); k++)
        {
            const double x = (xs[i] + xs[i + 1]) / 2, z = (zs[k] + zs[k + 1]) / 2;
            const bool hollow = std::any_of(
                recesses.begin(), recesses.end(),
                [&](const Recess& r)
                { return x > r.left && x < r.right && z > r.bottom && z < r.top; });
            if (hollow) continue;
            addQuad(
                mesh, at(xs[i], 0, zs[k]), at(xs[i + 1], 0, zs[k]), at(xs[i + 1], 0, zs[k + 1]),
                at(xs[i], 0, zs[k + 1]), reflectivity);
        }
    for (const Recess& r : recesses)
    {
        const std::array<std::array<double, 2>, 4> corners{
            {{r.left, r.bottom}, {r.right, r.bottom}, {r.right, r.top}, {r.left, r.top}}};
        for (std::size_t i = 0; i < 4 && r.depth != 0; i++)  // its sides
        {
            const auto &a = corners[i], &b = corners[(i + 1) % 4];
            addQuad(
                mesh, at(a[0], 0, a[1]), at(b[0], 0, b[1]), at(b[0], r.depth, b[1]),
                at(a[0], r.depth, a[1]), reflectivity);
        }
        if (r.open) continue;
        const std::size_t back = mesh.triangles.size();
        addQuad(
            mesh, at(r.left, r.depth, r.bottom), at(r.right, r.depth, r.bottom),
            at(r.right, r.depth, r.top), at(r.left, r.depth, r.top), r.reflectivity);
        if (r.window) mesh.mark(back, Material::Pane);
    }
}

void addExtrusion(
    Mesh& mesh, const Pose& T, const std::vector<std::array<double, 2>>& profile, double width,
    float reflectivity)
{
    Vector3d center = Vector3d::Zero();
    for (const auto& p : profile) center += Vector3d(p[0], 0, p[1]);
    center /= static_cast<double>(profile.size());
    const Vector3d side(0, width / 2, 0);
    for (std::size_t i = 0; i < profile.size(); i++)
    {
        const auto &p = profile[i], &q = profile[(i + 1) % profile.size()];
        const Vector3d a(p[0], 0, p[1]), b(q[0], 0, q[1]);
        addQuad(mesh, T * (a - side), T * (b - side), T * (b + side), T * (a + side), reflectivity);
        for (const double s : {-1.0, 1.0})
        {
            const auto ia = addVertex(mesh, T * (a + s * side));
            const auto ib = addVertex(mesh, T * (b + s * side));
            const auto ic = addVertex(mesh, T * (center + s * side));
            addTriangle(mesh, ia, ib, ic, reflectivity);
        }
    }
}

Mesh loadMesh(const std::string& path, float reflectivity)
{
    TriangleMesh read = readMesh(path);
    if (read.triangles.empty()) throw std::runtime_error("mesh '" + path + "': it has no faces");
    Mesh mesh;
    mesh.vertices = std::move(read.vertices);
    mesh.triangles = std::move(read.triangles);
    mesh.reflectivity.assign(mesh.triangles.size(), reflectivity);
    return mesh;
}
}  // namespace taut::simulation
