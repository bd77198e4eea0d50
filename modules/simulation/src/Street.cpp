#include <algorithm>
#include <array>
#include <cmath>

#include "StreetSide.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
// A rectangle of four streets around a block; coordinates of their middle lines.
constexpr double kBlockX = 160, kBlockY = 90;
constexpr double kMargin = 45;  // ground beyond the streets

double height(double x, double y)
{
    return 0.35 * std::sin(x / 41) + 0.3 * std::sin(y / 33 + 1);
}

std::vector<StreetSide> sides()
{
    const std::array<Vector3d, 4> corners{
        Vector3d(0, 0, 0), Vector3d(kBlockX, 0, 0), Vector3d(kBlockX, kBlockY, 0),
        Vector3d(0, kBlockY, 0)};
    std::vector<StreetSide> result;
    for (std::size_t i = 0; i < 4; i++)
    {
        result.push_back(outerSide(corners[i], corners[(i + 1) % 4], height));
        result.push_back(innerSide(corners[i], corners[(i + 1) % 4], height));
    }
    return result;
}
}  // namespace

World makeStreet(const WorldConfig& config, Random& random)
{
    World world;
    Mesh& mesh = world.mesh;
    addGround(mesh, -kMargin, -kMargin, kBlockX + kMargin, kBlockY + kMargin, 4, height, 0.25F);
    Movables cars;
    for (const StreetSide& side : sides()) addStreetSide(mesh, side, cars, random);
    cars.addTo(mesh, config);

    // Counter-clockwise in the right lane.
    const std::array<std::array<double, 2>, 4> corners{
        {{-kLane, -kLane},
         {kBlockX + kLane, -kLane},
         {kBlockX + kLane, kBlockY + kLane},
         {-kLane, kBlockY + kLane}}};
    for (std::size_t i = 0; i < 4; i++)
    {
        const Vector3d a(corners[i][0], corners[i][1], 0);
        const Vector3d b(corners[(i + 1) % 4][0], corners[(i + 1) % 4][1], 0);
        for (int k = 0; k < 40; k++)
        {
            Vector3d p = a + (b - a) * (k + 0.5) / 40;
            p.z() = height(p.x(), p.y());
            world.route.corners.push_back(p);
        }
    }
    // Start in the middle of the first street.
    std::rotate(
        world.route.corners.begin(), world.route.corners.begin() + 12, world.route.corners.end());
    world.route.rounding = 16;
    world.traffic = {true, 9, 14, 2 * kLane};
    return world;
}
}  // namespace taut::simulation
