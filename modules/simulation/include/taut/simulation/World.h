#pragma once

#include <cstdint>
#include <string>

#include "taut/core/Config.h"
#include "taut/simulation/Mesh.h"
#include "taut/simulation/Route.h"

namespace taut::simulation
{
enum class WorldType
{
    Hall,       //!< 36 x 22 x 7 m with pillars, racks and crates
    Corridor,   //!< 60 x 2.4 m, doors a few centimetres deep: weak along its axis
    Stairwell,  //!< five storeys of stairs
    Street,     //!< four streets around a block: facades, cars, poles, trees
    Forest,     //!< trunks on uneven ground
    Storeys,    //!< two alike storeys, each a ring of plain corridors, joined by one staircase
    Halls,      //!< four alike halls of 12 x 9 x 5 m in a row, along a corridor
    Blocks,     //!< 3 x 3 blocks of houses on gentle hills, between streets driven more than once
    Tunnel,     //!< 250 x 5 m, plain, between two open places
    Field,      //!< a plane of grass 120 m across, with little at its rim
    MeshFile,   //!< a PLY or OBJ file
};

/** Surfaces that are not as smooth and hard as triangles. */
struct Texture
{
    std::uint64_t seed = 0;
    double roughness = 0;           //!< heights over all that is solid, standard deviation [m]
    double roughness_length = 0.1;  //!< over which they change [m]
    double grass = 0;               //!< its height over soil [m]
    double grass_path = 0.2;        //!< mean way of light in it until a blade is met [m]
};

/** Leaves sway in it: sinusoids along x and y, a quarter of all leaves with the same phases. */
struct Wind
{
    double sway = 0;         //!< amplitude [m]
    double frequency = 0.4;  //!< [Hz]
};

/** People who walk with the body. They shift about while it rests. */
struct Companions
{
    int ahead = 0, beside = 0;  //!< number of them
    double distance = 1.5;      //!< of the nearest ahead [m]; half of it: of the nearest beside
};

struct WorldConfig
{
    WorldType type = WorldType::Hall;
    int seed = 1;        //!< of what is placed at random
    int moving = 0;      //!< number of people or cars that move
    double moved = 0;    //!< share of furniture or parked cars that stand elsewhere, 0..1
    int moved_seed = 1;  //!< of what stands elsewhere, and where; all else stays as it is
    double glass = 0;    //!< share of windows that give no return, 0..1
    double mirrors = 0;  //!< share of the other windows that mirror, 0..1
    Texture texture;
    Wind wind;
    Companions companions;
    int distinct = 0;           //!< for Halls: objects in each that the others do not have
    bool refuges = false;       //!< for Tunnel: recesses 0.4 m deep every 50 m in both walls
    std::string file;           //!< for MeshFile
    std::string route;          //!< for MeshFile: corners "x y z, x y z, ..." of the way [m]
    double rounding = 1;        //!< for MeshFile: of the corners of the route [m]
    double reflectivity = 0.5;  //!< for MeshFile
};

void declare(ConfigSection& section, WorldConfig& config);

/** What may move in a world. */
struct Traffic
{
    bool cars = false;    //!< else people
    double speed = 1.2;   //!< [m/s]
    double spacing = 3;   //!< at least, along the route, to the body and to one another [m]
    double oncoming = 0;  //!< lane to the left of the route for what comes towards; 0 = no room [m]
};

/** Surfaces, and a closed route that keeps clear of them. World frame: z up. */
struct World
{
    Mesh mesh;
    Route route;
    Traffic traffic;
};

/** Throws std::runtime_error if a file cannot be used. */
World makeWorld(const WorldConfig& config);
}  // namespace taut::simulation
