#include "Plants.h"

#include <cmath>

namespace taut::simulation
{
void addLeaves(
    Mesh& mesh, const Vector3d& center, const Vector3d& radii, int count, double edge,
    Random& random)
{
    const std::size_t first = mesh.triangles.size();
    for (int i = 0; i < count; i++)
    {
        const Vector3d direction = random.normalVector().normalized();
        const double r = std::cbrt(random.uniform(0.2, 1.0));
        const Vector3d p = center + r * direction.cwiseProduct(radii);
        for (int k = 0; k < 3; k++) mesh.vertices.push_back(p + edge / 2 * random.normalVector());
        const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.triangles.push_back({n - 3, n - 2, n - 1});
        mesh.reflectivity.push_back(static_cast<float>(random.uniform(0.3, 0.6)));
    }
    mesh.mark(first, Material::Leaf);
}

void addTree(Mesh& mesh, const Vector3d& foot, const Tree& tree, Random& random)
{
    const Vector3d lean(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 1);
    const Vector3d bend(random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06), 1);
    const Vector3d middle = foot + tree.height / 2 * lean;
    const Vector3d top = middle + tree.height / 2 * bend;
    addFrustum(mesh, foot - 0.4 * lean, middle, tree.radius, 0.75 * tree.radius, 14, 0.35F);
    addFrustum(mesh, middle, top, 0.75 * tree.radius, 0.3 * tree.radius, 12, 0.35F);
    const double crown = (tree.height - tree.crown_bottom) / 2;
    const Vector3d center = foot + (tree.crown_bottom + crown) * lean;
    for (int i = 0; i < 5; i++)  // branches
    {
        const double f = random.uniform(0.0, 0.8), angle = random.uniform(0, 2 * M_PI);
        const Vector3d from = foot + (tree.crown_bottom + f * crown) * lean;
        const Vector3d out(std::cos(angle), std::sin(angle), random.uniform(0.2, 0.8));
        addFrustum(mesh, from, from + 0.8 * tree.crown_radius * out, 0.06, 0.02, 7, 0.35F);
    }
    addLeaves(
        mesh, center, {tree.crown_radius, tree.crown_radius, crown}, tree.leaves, 0.35, random);
}

void addCar(Mesh& mesh, const Pose& T, float reflectivity, double scale)
{
    std::vector<std::array<double, 2>> profile{{-2.1, 0.3},  {2.1, 0.3},   {2.15, 0.75},
                                               {1.15, 0.95}, {0.45, 1.42}, {-1.1, 1.45},
                                               {-1.85, 1.0}, {-2.15, 0.9}};
    for (auto& p : profile)
        for (double& v : p) v *= scale;
    addExtrusion(mesh, T, profile, 1.75 * scale, reflectivity);
    for (const double x : {-1.3, 1.3})
        for (const double y : {-0.75, 0.75})
        {
            const Vector3d wheel = scale * Vector3d(x, y, 0.32), axle(0, 0.1 * scale, 0);
            addFrustum(
                mesh, T * (wheel - axle), T * (wheel + axle), 0.32 * scale, 0.32 * scale, 14, 0.1F);
        }
}
}  // namespace taut::simulation
