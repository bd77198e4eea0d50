#include "Walls.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr double kLength = 60, kWidth = 2.4, kHeight = 2.7;
}  // namespace

World makeCorridor(Random& random)
{
    World world;
    Mesh& mesh = world.mesh;
    const double half = kWidth / 2;
    addQuad(mesh, {0, -half, 0}, {kLength, -half, 0}, {kLength, half, 0}, {0, half, 0}, 0.3F);
    addQuad(
        mesh, {0, -half, kHeight}, {kLength, -half, kHeight}, {kLength, half, kHeight},
        {0, half, kHeight}, 0.75F);
    addWall(
        mesh, {Matrix3d::Identity(), {0, half, 0}}, kLength, kHeight, makeDoors(kLength, random),
        0.65F);
    addWall(
        mesh, {expSO3(Vector3d(0, 0, M_PI)), {kLength, -half, 0}}, kLength, kHeight,
        makeDoors(kLength, random), 0.65F);
    for (const double x : {0.0, kLength})
        addQuad(mesh, {x, -half, 0}, {x, half, 0}, {x, half, kHeight}, {x, -half, kHeight}, 0.65F);
    for (double x = 3; x < kLength; x += 6)  // lamps
        addStandingBox(mesh, {x, 0, kHeight - 0.05}, {1.2, 0.3, 0.05}, 0, 0.8F);

    const double lane = 0.35;
    world.route.corners = {
        {3, -lane, 0}, {kLength - 3, -lane, 0}, {kLength - 3, lane, 0}, {3, lane, 0}};
    world.route.rounding = 1.0;
    world.traffic.oncoming = 2 * lane;
    return world;
}
}  // namespace taut::simulation
