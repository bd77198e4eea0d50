#include <cmath>

#include "Movables.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr double kLength = 36, kWidth = 22, kHeight = 7;

void addRack(Mesh& mesh, double x, double y, double length, Random& random)
{
    for (const double z : {0.15, 1.4, 2.65})
    {
        addStandingBox(mesh, {x, y, z}, {length, 1.0, 0.06}, 0, 0.4F);
        for (double at = -length / 2 + 0.6; at < length / 2 - 0.5; at += random.uniform(0.8, 1.5))
        {
            const Vector3d size(
                random.uniform(0.4, 0.7), random.uniform(0.5, 0.9), random.uniform(0.3, 0.9));
            addStandingBox(
                mesh, {x + at, y, z + 0.06}, size, random.uniform(-0.15, 0.15),
                static_cast<float>(random.uniform(0.2, 0.8)));
        }
    }
    for (const double end : {-1.0, 1.0})
        for (const double side : {-1.0, 1.0})
            addStandingBox(
                mesh, {x + end * length / 2, y + side * 0.48, 0}, {0.1, 0.08, 3.2}, 0, 0.5F);
}

void addRoof(Mesh& mesh)
{
    for (double x = 4.5; x < kLength; x += 4.5)  // girders and purlins
        addStandingBox(mesh, {x, kWidth / 2, kHeight - 0.7}, {0.25, kWidth, 0.7}, 0, 0.5F);
    for (double y = 3; y < kWidth; y += 4)
        addStandingBox(mesh, {kLength / 2, y, kHeight - 0.25}, {kLength, 0.15, 0.25}, 0, 0.5F);
    addFrustum(mesh, {0.5, 1.2, 5.2}, {kLength - 0.5, 1.2, 5.2}, 0.3, 0.3, 20, 0.6F);  // duct
}

/** A crate, perhaps with a smaller one on it, or a drum. */
Movables::Thing makeClutter(Random& random)
{
    const double yaw = random.uniform(-0.8, 0.8);
    const auto shade = static_cast<float>(random.uniform(0.15, 0.8));
    if (random.uniform() < 0.3)
        return [=](Mesh& mesh, const Pose& T)
        { addFrustum(mesh, T.p, T.p + Vector3d(0, 0, 0.9), 0.3, 0.3, 20, shade); };
    const double edge = random.uniform(0.5, 1.2), top = random.uniform(0.4, 1.1);
    const Vector3d size(edge, random.uniform(0.5, 1.2), top);
    const bool stacked = random.uniform() < 0.4;
    return [=](Mesh& mesh, const Pose& T)
    {
        addStandingBox(mesh, T.p, size, yaw, shade);
        if (!stacked) return;
        addStandingBox(mesh, T.p + Vector3d(0, 0, top), {0.5, 0.4, 0.45}, yaw + 0.4, shade * 0.8F);
    };
}

void addClutter(Mesh& mesh, const WorldConfig& config, Random& random)
{
    // Crates and drums along the walls and in the middle, off the route.
    Movables clutter;
    const auto at = [](double x, double y) { return Pose{Matrix3d::Identity(), {x, y, 0}}; };
    const auto place = [&](double x, double y) { clutter.add(makeClutter(random), at(x, y)); };
    for (double x = 2; x < kLength - 1;)
    {
        place(x, 0.9);
        if (x > 6) place(x, kWidth - 0.9);
        const double gap = random.uniform(2.0, 4.0);
        if (gap > 3.2)
            for (const double y : {0.9, kWidth - 0.9})
                if (x > 6) clutter.addFreePlace(at(x + gap / 2, y));
        x += gap;
    }
    for (double y = 5; y < kWidth - 4; y += random.uniform(2.0, 4.0)) place(kLength - 0.9, y);
    for (int i = 0; i < 8; i++)
        place(random.uniform(9, kLength - 9), random.uniform(8.5, kWidth - 8.5));
    clutter.addTo(mesh, config);
}
}  // namespace

World makeHall(const WorldConfig& config, Random& random)
{
    World world;
    Mesh& mesh = world.mesh;
    addRoom(mesh, {0, 0, 0}, {kLength, kWidth, kHeight}, 0.5F);
    for (const double x : {9.0, 18.0, 27.0})
        for (const double y : {7.2, kWidth - 7.2})
            addStandingBox(mesh, {x, y, 0}, {0.5, 0.5, kHeight}, 0, 0.6F);
    for (double x = 3; x < kLength; x += 6)  // ribs of the walls
        for (const double y : {0.12, kWidth - 0.12})
            addStandingBox(mesh, {x, y, 0}, {0.4, 0.24, kHeight}, 0, 0.55F);
    addRoof(mesh);
    addRack(mesh, 13.5, kWidth / 2 + 1.2, 6, random);
    addRack(mesh, 22.5, kWidth / 2 - 1.2, 6, random);
    addClutter(mesh, config, random);
    // A gate that stands open, an office with a sloping roof, and a ramp.
    addStandingBox(mesh, {0.1, 15.5, 0}, {0.2, 4, 4.2}, 0, 0.3F);
    addStandingBox(mesh, {3.2, 19.6, 0}, {4.5, 3.6, 2.8}, 0, 0.7F);
    addQuad(mesh, {0.8, 17.7, 2.8}, {5.6, 17.7, 2.8}, {5.6, 21.6, 3.9}, {0.8, 21.6, 3.9}, 0.45F);
    addQuad(mesh, {32, 19, 0}, {35, 19, 1.1}, {35, 21.4, 1.1}, {32, 21.4, 0}, 0.4F);

    world.route.corners = {{6, 4.2, 0},   {31, 4.2, 0}, {32, 12, 0}, {29.5, 17.2, 0},
                           {18, 17.8, 0}, {7.5, 16, 0}, {5.5, 10, 0}};
    world.route.rounding = 4;
    world.traffic.oncoming = 1.5;
    return world;
}
}  // namespace taut::simulation
