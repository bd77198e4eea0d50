#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr int kStoreys = 5, kSteps = 10;               // steps of each of a storey's two flights
constexpr double kRise = 0.16, kRun = 0.28;            // of a step
constexpr double kLanding = 1.4, kFlightWidth = 1.35;  // [m]
constexpr double kEye = 0.2;                           // between the flights
constexpr double kHalfStorey = kSteps * kRise, kStorey = 2 * kHalfStorey;
constexpr double kLength = 2 * kLanding + kSteps * kRun, kHalfWidth = kFlightWidth + kEye / 2;
constexpr double kSlab = 0.16;  // thickness of landings

/** A flight that rises from z along +x (forward) or -x, on the side of the sign of y. */
void addFlight(Mesh& mesh, double z, bool forward, double side)
{
    for (int i = 0; i < kSteps; i++)
    {
        const double along = kLanding + (i + 0.5) * kRun;
        const double x = forward ? along : kLength - along;
        const Vector3d center(x, side * (kEye / 2 + kFlightWidth / 2), z + (i + 1) * kRise - 0.15);
        addBox(mesh, {Matrix3d::Identity(), center}, {kRun, kFlightWidth, 0.3}, 0.45F);
    }
    const double x0 = forward ? kLanding : kLength - kLanding;
    const double x1 = forward ? kLength - kLanding : kLanding;
    const double y = side * (kEye / 2 + 0.04);
    for (int i = 0; i <= 5; i++)  // banisters
    {
        const double f = i / 5.0, x = x0 + f * (x1 - x0), bottom = z + f * kHalfStorey;
        addFrustum(mesh, {x, y, bottom - 0.1}, {x, y, bottom + 0.9}, 0.02, 0.02, 8, 0.5F);
    }
    addFrustum(mesh, {x0, y, z + 0.95}, {x1, y, z + kHalfStorey + 0.95}, 0.03, 0.03, 8, 0.6F);
}

void addLanding(Mesh& mesh, double z, double x)
{
    addBox(
        mesh, {Matrix3d::Identity(), {x, 0, z - kSlab / 2}}, {kLanding, 2 * kHalfWidth, kSlab},
        0.4F);
}

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
        windows.push_back({kHalfWidth - 0.7, kHalfWidth + 0.7, sill, sill + 1.2, 0.25, 0.1F});
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
