#include <cmath>

#include "Plants.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr double kHalf = 60;     // the plane spans [-kHalf, kHalf] in x and y
constexpr double kGrass = 0.02;  // unevenness [m]

/** What stands at the edge: a barn and a few trees. */
void addRim(Mesh& mesh, Random& random)
{
    const Pose barn{expSO3(Vector3d(0, 0, 0.15)), {-12, 53, 0}};
    addStandingBox(mesh, barn.p, {18, 8, 4}, 0.15, 0.6F);
    addExtrusion(
        mesh, {barn.R * expSO3(Vector3d(0, 0, M_PI / 2)), barn.p + Vector3d(0, 0, 4)},
        {{-4.4, 0}, {4.4, 0}, {0, 2.6}}, 18.6, 0.35F);
    for (double angle = 0.3; angle < 2 * M_PI; angle += random.uniform(0.5, 1.1))
    {
        if (std::abs(angle - 1.8) < 0.35) continue;  // the barn
        const double radius = random.uniform(54, 58);
        addTree(
            mesh, {radius * std::cos(angle), radius * std::sin(angle), 0},
            {random.uniform(6, 11), random.uniform(0.15, 0.3), 2.5, random.uniform(1.5, 2.5), 200},
            random);
    }
}

/** Two laps around the middle, the second a few metres beside the first. */
Route makeRoute()
{
    Route route;
    constexpr int corners = 360;
    for (int i = 0; i < corners; i++)
    {
        const double angle = 4 * M_PI * i / corners;
        const double radius = 27 + 4 * std::sin(angle / 2) + 4 * std::cos(2 * angle);
        route.corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    route.rounding = 3;
    return route;
}
}  // namespace

World makeField(Random& random)
{
    World world;
    addGround(
        world.mesh, -kHalf, -kHalf, kHalf, kHalf, 1,
        [&random](double, double) { return random.uniform(-kGrass, kGrass); }, 0.35F);
    world.mesh.mark(0, Material::Soil);
    addRim(world.mesh, random);
    world.route = makeRoute();
    world.traffic.oncoming = 1.5;
    return world;
}
}  // namespace taut::simulation
