#include "taut/simulation/World.h"

#include <algorithm>
#include <initializer_list>
#include <sstream>

#include "Worlds.h"

namespace taut::simulation
{
namespace
{
Route parseRoute(const WorldConfig& config)
{
    Route route;
    route.rounding = config.rounding;
    std::istringstream corners(config.route);
    for (std::string text; std::getline(corners, text, ',');)
    {
        std::istringstream s(text);
        Vector3d p;
        if (!(s >> p.x() >> p.y() >> p.z()) || !(s >> std::ws).eof())
            throw ConfigError("configuration key 'world.route': '" + text + "' is not 'x y z'");
        route.corners.push_back(p);
    }
    return route;
}

void declareSurfaces(ConfigSection& section, WorldConfig& config, bool soil, bool leaves)
{
    Texture& texture = config.texture;
    section.key(
        "roughness", texture.roughness, {0, 0.5},
        "m, heights over what is solid, standard deviation");
    section.key(
        "roughness_length", texture.roughness_length, {1e-3, 10}, "m, over which they change");
    if (soil)
    {
        section.key("grass", texture.grass, {0, 3}, "m, its height");
        section.key(
            "grass_path", texture.grass_path, {1e-3, 100},
            "m, mean way of light in it until a blade is met");
    }
    if (!leaves) return;
    ConfigSection& wind = section.section("wind");
    wind.key("sway", config.wind.sway, {0, 2}, "m, amplitude of the leaves");
    wind.key("frequency", config.wind.frequency, {0.01, 20}, "Hz");
}

/** Makes a share of the panes mirrors. Each is drawn by its number, apart from all else. */
void silver(Mesh& mesh, const WorldConfig& config)
{
    constexpr std::size_t triangles = 2;  // of a pane
    std::size_t panes = 0;
    for (std::size_t i = 0; i < mesh.materials.size(); i++)
    {
        if (mesh.materials[i] != Material::Pane) continue;
        Random random(static_cast<std::uint64_t>(config.seed), 6, panes++ / triangles);
        mesh.materials[i] = random.uniform() < config.mirrors ? Material::Mirror : Material::Solid;
    }
}

World build(const WorldConfig& config);
}  // namespace

void declare(ConfigSection& section, WorldConfig& config)
{
    section.choice<WorldType>(
        "type", config.type,
        {{"hall", WorldType::Hall},
         {"corridor", WorldType::Corridor},
         {"stairwell", WorldType::Stairwell},
         {"street", WorldType::Street},
         {"forest", WorldType::Forest},
         {"storeys", WorldType::Storeys},
         {"halls", WorldType::Halls},
         {"blocks", WorldType::Blocks},
         {"tunnel", WorldType::Tunnel},
         {"field", WorldType::Field},
         {"mesh", WorldType::MeshFile}},
        "kind of world");
    section.key("seed", config.seed, {0, 1e9}, "of what is placed at random");
    section.key("moving", config.moving, {0, 100}, "number of people or cars that move");
    const auto isOneOf = [&config](std::initializer_list<WorldType> types)
    { return std::find(types.begin(), types.end(), config.type) != types.end(); };
    if (isOneOf({WorldType::Hall, WorldType::Street, WorldType::Halls, WorldType::Blocks}))
    {
        section.key(
            "moved", config.moved, {0, 1},
            "share of furniture or parked cars that stand elsewhere");
        section.key("moved_seed", config.moved_seed, {0, 1e9}, "of what stands where then");
    }
    if (isOneOf({WorldType::Storeys, WorldType::Halls}))
        section.key("glass", config.glass, {0, 1}, "share of windows that give no return");
    if (isOneOf(
            {WorldType::Storeys, WorldType::Halls, WorldType::Stairwell, WorldType::Street,
             WorldType::Blocks}))
        section.key("mirrors", config.mirrors, {0, 1}, "share of the other windows that mirror");
    declareSurfaces(
        section, config, isOneOf({WorldType::Forest, WorldType::Field}),
        isOneOf({WorldType::Forest, WorldType::Field, WorldType::Street, WorldType::Blocks}));
    ConfigSection& companions = section.section("companions");
    companions.key("ahead", config.companions.ahead, {0, 5}, "people who walk before the body");
    companions.key("beside", config.companions.beside, {0, 5}, "people who walk at its sides");
    companions.key(
        "distance", config.companions.distance, {0.5, 20},
        "m, of the nearest ahead; half of it beside");
    if (config.type == WorldType::Halls)
        section.key("distinct", config.distinct, {0, 6}, "objects in each hall, not in the others");
    if (config.type == WorldType::Tunnel)
        section.key("refuges", config.refuges, "recesses 0.4 m deep every 50 m in both walls");
    if (config.type != WorldType::MeshFile) return;
    section.key("file", config.file, "PLY or OBJ, metres, z up");
    section.key("route", config.route, "corners 'x y z, x y z, ...' of a closed way [m]");
    section.key("rounding", config.rounding, kNotNegative, "m, of the corners of the route");
    section.key("reflectivity", config.reflectivity, {0.01, 1}, "of its surfaces");
}

World makeWorld(const WorldConfig& config)
{
    World world = build(config);
    silver(world.mesh, config);
    return world;
}

namespace
{
World build(const WorldConfig& config)
{
    Random random(static_cast<std::uint64_t>(config.seed), 2);
    switch (config.type)
    {
        case WorldType::Hall:
            return makeHall(config, random);
        case WorldType::Corridor:
            return makeCorridor(random);
        case WorldType::Stairwell:
            return makeStairwell(random);
        case WorldType::Street:
            return makeStreet(config, random);
        case WorldType::Forest:
            return makeForest(random);
        case WorldType::Storeys:
            return makeStoreys(config, random);
        case WorldType::Halls:
            return makeHalls(config, random);
        case WorldType::Blocks:
            return makeBlocks(config, random);
        case WorldType::Tunnel:
            return makeTunnel(config, random);
        case WorldType::Field:
            return makeField(random);
        case WorldType::MeshFile:
            break;
    }
    return {loadMesh(config.file, static_cast<float>(config.reflectivity)), parseRoute(config), {}};
}
}  // namespace
}  // namespace taut::simulation
