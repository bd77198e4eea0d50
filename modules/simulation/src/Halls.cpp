#include "Furniture.h"
#include "Movables.h"
#include "Walls.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr int kHalls = 4;
constexpr double kLength = 12, kDepth = 9, kHeight = 5;  // of a hall
constexpr double kWall = 0.3;                            // between it and whatever is beside it
constexpr double kPitch = kLength + kWall;
constexpr double kCorridor = 2.6, kCorridorHeight = 3;
constexpr double kDoorway = 1.4, kDoorHeight = 2.2;
constexpr double kIn = 2.5, kOut = kLength - 2.5;  // the two doorways of a hall
constexpr std::size_t kFurniture = 8;              // alike in all halls

/** Where furniture may stand in a hall, off the way through it. */
std::vector<Pose> makePlaces()
{
    std::vector<Pose> places;
    const auto add = [&places](double x, double y, double yaw) {
        places.push_back({expSO3(Vector3d(0, 0, yaw)), {x, kWall + y, 0}});
    };
    for (const double x : {1.0, 2.7, 4.4, 6.1, 7.8, 9.5, 11.1}) add(x, 8.5, 0.05);
    for (const double y : {2.5, 4.3, 6.1})
    {
        add(0.6, y, M_PI / 2);
        add(kLength - 0.6, y, -M_PI / 2);
    }
    for (const double x : {4.4, 6.0, 7.6}) add(x, 0.6, M_PI);
    for (const double x : {5.0, 7.0})
    {
        add(x, 3.2, 0.4);
        add(x, 4.9, -0.7);
    }
    return places;
}

std::vector<Recess> makeWindows(const WorldConfig& config)
{
    std::vector<Recess> recesses;
    for (double x = 0.6; x < kLength - 1; x += 1.9)
        recesses.push_back({x, x + 1.3, 1.2, 3.4, 0.15, 0.1F, false, true});
    glaze(recesses, config);
    return recesses;
}

void addHall(Mesh& mesh, const WorldConfig& config)
{
    const double back = kWall + kDepth;
    for (const double z : {0.0, kHeight})
        addQuad(mesh, {0, kWall, z}, {kLength, kWall, z}, {kLength, back, z}, {0, back, z}, 0.45F);
    const auto doorway = [](double x)
    { return makeDoorway(kLength - x, kDoorway, kDoorHeight, kWall / 2); };
    const Vector3d a(0, kWall, 0), b(0, back, 0), c(kLength, back, 0), d(kLength, kWall, 0);
    addWallAlong(mesh, a, b, kHeight, {}, 0.6F);
    addWallAlong(mesh, b, c, kHeight, makeWindows(config), 0.6F);
    addWallAlong(mesh, c, d, kHeight, {}, 0.6F);
    addWallAlong(mesh, d, a, kHeight, {doorway(kOut), doorway(kIn)}, 0.6F);
    for (const double x : {kLength / 3, 2 * kLength / 3})  // girders
        addStandingBox(mesh, {x, kWall + kDepth / 2, kHeight - 0.5}, {0.2, kDepth, 0.5}, 0, 0.5F);
    addFrustum(mesh, {0, back - 0.6, 4.2}, {kLength, back - 0.6, 4.2}, 0.2, 0.2, 16, 0.6F);  // duct
}

void addCorridor(Mesh& mesh, Random& random)
{
    const double begin = -kWall / 2, end = kLength + kWall / 2;
    for (const double z : {0.0, kCorridorHeight})
        addQuad(
            mesh, {begin, -kCorridor, z}, {end, -kCorridor, z}, {end, 0, z}, {begin, 0, z}, 0.4F);
    const auto doorway = [&](double x)
    { return makeDoorway(x - begin, kDoorway, kDoorHeight, kWall / 2); };
    addWallAlong(
        mesh, {begin, 0, 0}, {end, 0, 0}, kCorridorHeight, {doorway(kIn), doorway(kOut)}, 0.65F);
    addWallAlong(
        mesh, {end, -kCorridor, 0}, {begin, -kCorridor, 0}, kCorridorHeight,
        makeDoors(kPitch, random), 0.65F);
}

Movables::Thing makeThing(Random& random)
{
    return [thing = makeFurniture(random)](Mesh& mesh, const Pose& T) { mesh.append(thing, T); };
}

/** Through every hall in turn, in by one doorway and out by the other, and back by the corridor. */
Route makeRoute()
{
    Route route;
    auto& c = route.corners;
    const double there = -0.9, back = -1.9;  // lanes of the corridor
    const double far = kWall + 6.6;
    for (int hall = 0; hall < kHalls; hall++)
    {
        const double x = hall * kPitch;
        c.insert(
            c.end(), {{x + kIn, there, 0},
                      {x + kIn, 2, 0},
                      {x + 2.2, far, 0},
                      {x + kLength - 2.2, far, 0},
                      {x + kOut, 2, 0},
                      {x + kOut, there, 0}});
    }
    const double last = (kHalls - 1) * kPitch + kOut;
    c.insert(c.end(), {{last + 1.5, there, 0}, {last + 1.5, back, 0}, {1, back, 0}, {1, there, 0}});
    route.rounding = 1.2;
    return route;
}
}  // namespace

World makeHalls(const WorldConfig& config, Random& random)
{
    World world;
    Mesh section;  // a hall and what there is of the corridor before it
    addHall(section, config);
    addCorridor(section, random);
    std::vector<Pose> places = makePlaces();
    shuffle(places, random);
    std::vector<Movables::Thing> alike;
    for (std::size_t i = 0; i < kFurniture; i++) alike.push_back(makeThing(random));

    Movables furniture;
    for (int hall = 0; hall < kHalls; hall++)
    {
        const Pose T_world_hall{Matrix3d::Identity(), {hall * kPitch, 0, 0}};
        world.mesh.append(section, T_world_hall);
        for (std::size_t i = 0; i < kFurniture; i++)
            furniture.add(alike[i], T_world_hall * places[i]);
        std::vector<Pose> others(places.begin() + kFurniture, places.end());
        shuffle(others, random);
        for (std::size_t i = 0; i < others.size(); i++)
            if (i < static_cast<std::size_t>(config.distinct))
                furniture.add(makeThing(random), T_world_hall * others[i]);
            else
                furniture.addFreePlace(T_world_hall * others[i]);
    }
    furniture.addTo(world.mesh, config);
    for (const double x : {-kWall / 2, kHalls * kPitch - kWall / 2})  // ends of the corridor
        addQuad(
            world.mesh, {x, -kCorridor, 0}, {x, 0, 0}, {x, 0, kCorridorHeight},
            {x, -kCorridor, kCorridorHeight}, 0.65F);
    world.route = makeRoute();
    return world;
}
}  // namespace taut::simulation
