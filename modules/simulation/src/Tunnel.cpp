#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "Plants.h"
#include "Walls.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr double kLength = 250, kWidth = 5, kHeight = 4.5, kHalf = kWidth / 2;
constexpr double kRefugePitch = 50, kRefugeDepth = 0.4;
constexpr double kPlaceX = 50, kPlaceY = 25;  // the open places: depth, half of the width
constexpr double kLane = 0.9;

std::vector<Recess> makeRefuges()
{
    std::vector<Recess> recesses;
    for (double x = kRefugePitch / 2; x < kLength; x += kRefugePitch)
        recesses.push_back({x - 1, x + 1, 0, 2.2, kRefugeDepth, 0.5F});
    return recesses;
}

void addTube(Mesh& mesh, const std::vector<Recess>& recesses)
{
    addWallAlong(mesh, {0, kHalf, 0}, {kLength, kHalf, 0}, kHeight, recesses, 0.5F);
    addWallAlong(mesh, {kLength, -kHalf, 0}, {0, -kHalf, 0}, kHeight, recesses, 0.5F);
    for (const double z : {0.0, kHeight})
        addQuad(
            mesh, {0, -kHalf, z}, {kLength, -kHalf, z}, {kLength, kHalf, z}, {0, kHalf, z}, 0.3F);
}

/** What lies before a portal, in its frame: x leads out of the tunnel. */
Mesh makePlace(Random& random)
{
    Mesh mesh;
    addQuad(
        mesh, {0, -kPlaceY, 0}, {kPlaceX, -kPlaceY, 0}, {kPlaceX, kPlaceY, 0}, {0, kPlaceY, 0},
        0.3F);
    addWallAlong(
        mesh, {0, -kPlaceY, 0}, {0, kPlaceY, 0}, 9, {makeDoorway(kPlaceY, kWidth, kHeight, 0)},
        0.5F);
    const auto addBlock = [&](double x, double y, const Vector3d& size, float shade) {
        addStandingBox(mesh, {x, y, 0}, size, random.uniform(-0.4, 0.4), shade);
    };
    for (const double side : {-1.0, 1.0})
    {
        const double house = random.uniform(14, 34);
        addBlock(house, side * 20, {random.uniform(8, 12), 5, random.uniform(3.5, 7)}, 0.6F);
        for (int i = 0; i < 4; i++)  // containers, trees and poles around the way
        {
            const double x = 6 + 10 * i + random.uniform(0, 4), y = side * random.uniform(12.5, 14);
            if (i % 2 == 0)
                addBlock(x, y, {random.uniform(1, 3), 1.2, random.uniform(1, 2.5)}, 0.4F);
            else
                addTree(mesh, {x, y, 0}, {6, 0.15, 2.6, 1.7, 120}, random);
            addFrustum(mesh, {x + 4, side * 12, 0}, {x + 4, side * 12, 6}, 0.1, 0.06, 12, 0.5F);
        }
    }
    addBlock(28, 0, {random.uniform(2, 4), 2, 2.5}, 0.5F);
    return mesh;
}

/** Through on the right, around the place at the other end, back, and around the first one. */
Route makeRoute()
{
    Route route;
    const auto loop = [&route](const Pose& T_world_portal)
    {
        for (const auto& [x, y] : std::initializer_list<std::pair<double, double>>{
                 {6, -kLane}, {17, -8}, {30, -9}, {39, 0}, {30, 9}, {17, 8}, {6, kLane}})
            route.corners.push_back(T_world_portal * Vector3d(x, y, 0));
    };
    loop({expSO3(Vector3d(0, 0, M_PI)), Vector3d::Zero()});
    loop({Matrix3d::Identity(), {kLength, 0, 0}});
    // Start before the first portal.
    std::rotate(route.corners.begin(), route.corners.begin() + 4, route.corners.end());
    route.rounding = 8;
    return route;
}
}  // namespace

World makeTunnel(const WorldConfig& config, Random& random)
{
    World world;
    addTube(world.mesh, config.refuges ? makeRefuges() : std::vector<Recess>{});
    world.mesh.append(makePlace(random), {expSO3(Vector3d(0, 0, M_PI)), Vector3d::Zero()});
    world.mesh.append(makePlace(random), {Matrix3d::Identity(), {kLength, 0, 0}});
    world.route = makeRoute();
    world.traffic = {true, 6, 12, 0};
    return world;
}
}  // namespace taut::simulation
