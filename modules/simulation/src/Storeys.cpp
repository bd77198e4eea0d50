#include "Stairs.h"
#include "Walls.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
// The corridors of a storey go around a rectangle; its corners are those of their middle lines.
constexpr double kRingX = 30, kRingY = 20;
constexpr double kWidth = 2.4, kHeight = 2.7, kHalf = kWidth / 2;
constexpr double kStairsX = 12;  // of the doorway to the stairs, in the inner wall at y = kHalf
constexpr double kDoorway = 1.4, kDoorHeight = 2.1, kJamb = 0.2;
constexpr double kRoomHeight = stairs::kStorey + kHeight;  // of the staircase

/** Corners of the ring, counter-clockwise, moved out of it by `out` [m]. */
std::vector<Vector3d> corners(double out, double z = 0)
{
    return {
        {-out, -out, z},
        {kRingX + out, -out, z},
        {kRingX + out, kRingY + out, z},
        {-out, kRingY + out, z}};
}

/** The doors of the wall with the doorway, but for those in its place. */
std::vector<Recess> besidesDoorway(const std::vector<Recess>& doors)
{
    const Recess doorway = makeDoorway(kStairsX - kHalf, kDoorway, kDoorHeight, kJamb);
    std::vector<Recess> recesses{doorway};
    for (const Recess& door : doors)
        if (door.right < doorway.left - 0.3 || door.left > doorway.right + 0.3)
            recesses.push_back(door);
    return recesses;
}

std::vector<Recess> makeWindows(double length, const WorldConfig& config, int wall)
{
    std::vector<Recess> recesses;
    for (double x = 2; x + 1.4 < length - 1; x += 3)
        recesses.push_back({x, x + 1.4, 0.9, 2.1, 0.06, 0.1F, false, true});
    glaze(recesses, config, wall);
    return recesses;
}

/** Floor and walls of one storey, at z = 0: both are made of it. */
Mesh makeStorey(const WorldConfig& config, Random& random)
{
    Mesh mesh;
    const auto inner = corners(-kHalf), outer = corners(kHalf);
    for (std::size_t i = 0; i < 4; i++)
    {
        const std::size_t next = (i + 1) % 4;
        const bool is_short = i % 2 == 1;
        const Vector3d up(0, 0, kHeight);
        addQuad(mesh, inner[i], outer[i], outer[next], inner[next], 0.3F);
        addQuad(mesh, inner[i] + up, outer[i] + up, outer[next] + up, inner[next] + up, 0.75F);

        const double inside = (inner[next] - inner[i]).norm();
        const auto doors = makeDoors(inside, random);
        addWallAlong(
            mesh, inner[i], inner[next], kHeight, i == 0 ? besidesDoorway(doors) : doors, 0.65F);
        const double outside = (outer[next] - outer[i]).norm();
        const auto recesses = is_short ? makeWindows(outside, config, static_cast<int>(i))
                                       : makeDoors(outside, random);
        addWallAlong(mesh, outer[next], outer[i], kHeight, recesses, 0.65F);

        const Vector3d leg = corners(0)[next] - corners(0)[i];
        for (double s = 3; s < leg.norm(); s += 6)  // lamps
        {
            const Vector3d at = corners(0)[i] + s * leg.normalized() + up;
            const Vector3d size = is_short ? Vector3d(0.3, 1.2, 0.05) : Vector3d(1.2, 0.3, 0.05);
            addStandingBox(mesh, at - Vector3d(0, 0, 0.05), size, 0, 0.8F);
        }
    }
    return mesh;
}

Pose stairsPose()
{
    return {expSO3(Vector3d(0, 0, M_PI / 2)), {kStairsX, kHalf + kJamb, 0}};
}

/** The staircase in its own frame, with a doorway on either storey. */
Mesh makeStaircase()
{
    using namespace stairs;
    Mesh mesh;
    for (const double z : {0.0, kRoomHeight})
        addQuad(
            mesh, {0, -kHalfWidth, z}, {kLength, -kHalfWidth, z}, {kLength, kHalfWidth, z},
            {0, kHalfWidth, z}, 0.6F);
    Recess below = makeDoorway(kHalfWidth, kDoorway, kDoorHeight, 0), above = below;
    above.bottom += kStorey;
    above.top += kStorey;
    const Vector3d a(0, -kHalfWidth, 0), b(0, kHalfWidth, 0), c(kLength, kHalfWidth, 0),
        d(kLength, -kHalfWidth, 0);
    addWallAlong(mesh, a, b, kRoomHeight, {below, above}, 0.7F);
    addWallAlong(mesh, b, c, kRoomHeight, {}, 0.7F);
    addWallAlong(mesh, c, d, kRoomHeight, {}, 0.7F);
    addWallAlong(mesh, d, a, kRoomHeight, {}, 0.7F);

    addFlight(mesh, 0, true, -1);
    addLanding(mesh, kHalfStorey, kLength - kLanding / 2);
    addFlight(mesh, kHalfStorey, false, 1);
    addLanding(mesh, kStorey, kLanding / 2);
    const double rail = kStorey + 0.95;  // where the upper landing ends over the lower flight
    addFrustum(
        mesh, {kLanding, -kHalfWidth, rail}, {kLanding, -kEye / 2, rail}, 0.03, 0.03, 8, 0.6F);
    return mesh;
}

/** From doorway to doorway, up the stairs. */
std::vector<Vector3d> wayUp()
{
    using namespace stairs;
    constexpr double lane = (kEye + kFlightWidth) / 2;  // the middle of a flight
    constexpr double turn = kLength - kLanding / 2;
    std::vector<Vector3d> way{
        {-kJamb, 0, 0},
        {0.6, -0.6 * lane, 0},
        {kLanding, -lane, 0},
        {kLength - kLanding, -lane, kHalfStorey},
        {turn, -lane, kHalfStorey},
        {turn, lane, kHalfStorey},
        {kLength - kLanding, lane, kHalfStorey},
        {kLanding, lane, kStorey},
        {0.6, 0.6 * lane, kStorey},
        {-kJamb, 0, kStorey}};
    for (Vector3d& p : way) p = stairsPose() * p;
    return way;
}

/** Twice around below, up, twice around above, and down. */
Route makeRoute()
{
    Route route;
    auto& c = route.corners;
    const auto goRoundTwice = [&c](double z)
    {
        const std::vector<Vector3d> ring = corners(0, z);
        for (int lap = 0; lap < 2; lap++)
        {
            c.insert(c.end(), ring.begin() + 1, ring.end());
            c.push_back(ring.front());
        }
        c.emplace_back(kStairsX, 0, z);
    };
    const std::vector<Vector3d> up = wayUp();
    c.emplace_back(kStairsX + 3, 0, 0);
    goRoundTwice(0);
    c.insert(c.end(), up.begin(), up.end());
    c.emplace_back(kStairsX, 0, stairs::kStorey);
    goRoundTwice(stairs::kStorey);
    c.insert(c.end(), up.rbegin(), up.rend());
    c.emplace_back(kStairsX, 0, 0);
    route.rounding = 1;
    return route;
}
}  // namespace

World makeStoreys(const WorldConfig& config, Random& random)
{
    World world;
    const Mesh storey = makeStorey(config, random);
    world.mesh.append(storey);
    world.mesh.append(storey, {Matrix3d::Identity(), {0, 0, stairs::kStorey}});
    world.mesh.append(makeStaircase(), stairsPose());
    world.route = makeRoute();
    return world;
}
}  // namespace taut::simulation
