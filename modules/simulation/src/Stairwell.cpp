#include "Stairs.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
using namespace stairs;

constexpr int kStoreys = 5;

void addShaft(Mesh& mesh)
{
    const double height = kStoreys * kStorey + 2.8;
    std::vector<Recess> doors, windows;
    for (int storey = 0; storey <= kStoreys; storey++)
    {
        const double z = storey * kStorey;
        doors.push_back({kHalfWidth - 0.5, kHalfWidth + 0.5, z + 0.01, z + 2.1, 0.12, 0.3F});
        if (storey == kStoreys) break;
        const double sill = z + kHalfStorey + 1.0;
        windows.push_back(
            {kHalfWidth - 0.7, kHalfWidth + 0.7, sill, sill + 1.2, 0.25, 0.1F, false, true});
    }
    const auto turned = [](double yaw) { return expSO3(Vector3d(0, 0, yaw)); };
    addWall(mesh, {turned(M_PI / 2), {0, -kHalfWidth, 0}}, 2 * kHalfWidth, height, doors, 0.7F);
    addWall(
        mesh, {turned(-M_PI / 2), {kLength, kHalfWidth, 0}}, 2 * kHalfWidth, height, windows, 0.7F);
    for (const double y : {-kHalfWidth, kHalfWidth})
        addQuad(mesh, {0, y, 0}, {kLength, y, 0}, {kLength, y, height}, {0, y, height}, 0.7F);
    for (const double z : {0.0, height})
        addQuad(
            mesh, {0, -kHalfWidth, z}, {kLength, -kHalfWidth, z}, {kLength, kHalfWidth, z},
            {0, kHalfWidth, z}, 0.6F);
}

/** Up along the walls and down along the banisters. */
Route upAndDown()
{
    Route route;
    auto& c = route.corners;
    const double out = 0.98, in = 0.52;            // lanes, from the middle
    const double low = 0.6, high = kLength - 0.6;  // on the landings, outer lane
    const double foot = kLanding, head = kLength - kLanding;
    for (int storey = 0; storey < kStoreys; storey++)
    {
        const double z = storey * kStorey, middle = z + kHalfStorey, top = z + kStorey;
        c.insert(
            c.end(), {{low, -out, z},
                      {foot, -out, z},
                      {head, -out, middle},
                      {high, -out, middle},
                      {high, out, middle},
                      {head, out, middle},
                      {foot, out, top},
                      {low, out, top}});
    }
    for (int storey = kStoreys; storey > 0; storey--)
    {
        const double z = storey * kStorey, middle = z - kHalfStorey, bottom = z - kStorey;
        c.insert(
            c.end(), {{low + 0.3, in, z},
                      {foot, in, z},
                      {head, in, middle},
                      {high - 0.3, in, middle},
                      {high - 0.3, -in, middle},
                      {head, -in, middle},
                      {foot, -in, bottom},
                      {low + 0.3, -in, bottom}});
    }
    route.rounding = 0.8;
    return route;
}
}  // namespace

World makeStairwell(Random& random)
{
    World world;
    Mesh& mesh = world.mesh;
    addShaft(mesh);
    for (int storey = 0; storey <= kStoreys; storey++)
    {
        const double z = storey * kStorey;
        if (storey > 0) addLanding(mesh, z, kLanding / 2);
        if (storey == kStoreys) break;
        addFlight(mesh, z, true, -1);
        addLanding(mesh, z + kHalfStorey, kLength - kLanding / 2);
        addFlight(mesh, z + kHalfStorey, false, 1);
        // A letter box or a hydrant, different on every storey.
        addStandingBox(
            mesh, {0.06, random.uniform(0.7, 1.2), z + random.uniform(0.9, 1.3)},
            {0.12, random.uniform(0.25, 0.5), random.uniform(0.3, 0.6)}, 0, 0.5F);
    }
    world.route = upAndDown();
    return world;
}
}  // namespace taut::simulation
