#include "Walls.h"

#include <cmath>
#include <numeric>

namespace taut::simulation
{
Pose wallAlong(const Vector3d& from, const Vector3d& to)
{
    const Vector3d d = to - from;
    return {expSO3(Vector3d(0, 0, std::atan2(d.y(), d.x()))), from};
}

void addWallAlong(
    Mesh& mesh, const Vector3d& from, const Vector3d& to, double height,
    const std::vector<Recess>& recesses, float reflectivity)
{
    addWall(mesh, wallAlong(from, to), (to - from).norm(), height, recesses, reflectivity);
}

std::vector<Recess> makeDoors(double length, Random& random)
{
    std::vector<Recess> recesses;
    double x = random.uniform(2.0, 4.0);
    while (x < length - 3)
    {
        recesses.push_back({x, x + 1.0, 0, 2.1, random.uniform(0.04, 0.07), 0.35F});
        x += random.uniform(4.0, 7.0);
    }
    return recesses;
}

Recess makeDoorway(double at, double width, double height, double depth)
{
    return {at - width / 2, at + width / 2, 0, height, depth, 0.35F, true};
}

void glaze(std::vector<Recess>& windows, const WorldConfig& config, int wall)
{
    Random random(static_cast<std::uint64_t>(config.seed), 5, static_cast<std::uint64_t>(wall));
    std::vector<std::size_t> order(windows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    shuffle(order, random);
    order.resize(
        static_cast<std::size_t>(std::lround(config.glass * static_cast<double>(order.size()))));
    for (const std::size_t i : order) windows[i].open = true;
}
}  // namespace taut::simulation
