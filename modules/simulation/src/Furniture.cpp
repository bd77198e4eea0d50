#include "Furniture.h"

namespace taut::simulation
{
namespace
{
void addTable(Mesh& mesh, double length, double depth, float shade)
{
    addStandingBox(mesh, {0, 0, 0.71}, {length, depth, 0.04}, 0, shade);
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            addStandingBox(
                mesh, {x * (length / 2 - 0.05), y * (depth / 2 - 0.05), 0}, {0.06, 0.06, 0.71}, 0,
                shade);
}

void addShelf(Mesh& mesh, double length, double depth, double height, float shade)
{
    for (const double x : {-length / 2, length / 2})
        addStandingBox(mesh, {x, 0, 0}, {0.03, depth, height}, 0, shade);
    for (double z = 0.1; z < height; z += 0.4)
        addStandingBox(mesh, {0, 0, z}, {length, depth, 0.03}, 0, shade);
}
}  // namespace

Mesh makeFurniture(Random& random)
{
    Mesh mesh;
    const double kind = random.uniform(), length = random.uniform(0.7, 1.3);
    const double depth = random.uniform(0.4, 0.75), height = random.uniform(1.1, 2.0);
    const auto shade = static_cast<float>(random.uniform(0.2, 0.8));
    if (kind < 0.25)
        addStandingBox(mesh, Vector3d::Zero(), {length, depth, height}, 0, shade);
    else if (kind < 0.5)
        addTable(mesh, length, depth, shade);
    else if (kind < 0.7)
        addStandingBox(mesh, Vector3d::Zero(), {length, depth, height / 2}, 0.2, shade);
    else if (kind < 0.85)
        addFrustum(mesh, {0, 0, 0}, {0, 0, height / 2}, depth / 2, depth / 2, 20, shade);
    else
        addShelf(mesh, length, depth, height, shade);
    return mesh;
}
}  // namespace taut::simulation
