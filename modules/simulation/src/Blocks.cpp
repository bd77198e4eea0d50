#include <algorithm>
#include <array>
#include <cmath>

#include "StreetSide.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr int kBlocks = 3;                     // along either axis
constexpr double kPitchX = 110, kPitchY = 80;  // of the middle lines of the streets
constexpr double kMargin = 45;                 // ground beyond the streets
constexpr double kStep = 4;                    // between the points of the route

double height(double x, double y)
{
    return 1.7 * std::sin(x / 52) + 1.5 * std::sin(y / 44 + 1);
}

Vector3d crossing(int i, int j)
{
    return {i * kPitchX, j * kPitchY, 0};
}

void addRectangle(
    Mesh& mesh, const Vector3d& min, const Vector3d& max,
    StreetSide (*side)(const Vector3d&, const Vector3d&, const Terrain&), Movables& cars,
    Random& random)
{
    const std::array<Vector3d, 4> corners{
        min, Vector3d(max.x(), min.y(), 0), max, Vector3d(min.x(), max.y(), 0)};
    for (std::size_t i = 0; i < 4; i++)
        addStreetSide(mesh, side(corners[i], corners[(i + 1) % 4], height), cars, random);
}

/** From crossing to crossing. Two streets are driven twice in the same direction, one in both. */
std::vector<Vector3d> makeTour()
{
    const std::vector<std::array<int, 2>> tour{
        {0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {1, 1}, {1, 0}, {2, 0},
        {2, 1}, {2, 2}, {3, 2}, {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {1, 2}, {1, 1}, {0, 1}};
    std::vector<Vector3d> crossings;
    crossings.reserve(tour.size());
    for (const auto& [i, j] : tour) crossings.push_back(crossing(i, j));
    return crossings;
}

/** The corners of the right lane of a closed tour. */
std::vector<Vector3d> rightLane(const std::vector<Vector3d>& tour)
{
    const std::size_t n = tour.size();
    const auto right = [&](std::size_t leg)
    {
        const Vector3d d = (tour[(leg + 1) % n] - tour[leg]).normalized();
        return Vector3d(d.y(), -d.x(), 0);
    };
    std::vector<Vector3d> lane;
    for (std::size_t i = 0; i < n; i++)
    {
        const Vector3d before = right((i + n - 1) % n), after = right(i);
        const bool straight = before.dot(after) > 0.5;
        const Vector3d aside = after + (straight ? 0.0 : 1.0) * before;
        lane.emplace_back(tour[i] + kLane * aside);
    }
    return lane;
}

Route makeRoute()
{
    Route route;
    const std::vector<Vector3d> lane = rightLane(makeTour());
    for (std::size_t i = 0; i < lane.size(); i++)
    {
        const Vector3d leg = lane[(i + 1) % lane.size()] - lane[i];
        const int steps = static_cast<int>(std::ceil(leg.norm() / kStep));
        for (int k = 0; k < steps; k++)
        {
            Vector3d p = lane[i] + leg * k / steps;
            p.z() = height(p.x(), p.y());
            route.corners.push_back(p);
        }
    }
    // Start in the middle of the first street.
    std::rotate(route.corners.begin(), route.corners.begin() + 12, route.corners.end());
    route.rounding = 16;
    return route;
}
}  // namespace

World makeBlocks(const WorldConfig& config, Random& random)
{
    World world;
    const Vector3d far = crossing(kBlocks, kBlocks);
    addGround(
        world.mesh, -kMargin, -kMargin, far.x() + kMargin, far.y() + kMargin, 4, height, 0.25F);
    Movables cars;
    addRectangle(world.mesh, crossing(0, 0), far, outerSide, cars, random);
    for (int i = 0; i < kBlocks; i++)
        for (int j = 0; j < kBlocks; j++)
            addRectangle(
                world.mesh, crossing(i, j), crossing(i + 1, j + 1), innerSide, cars, random);
    cars.addTo(world.mesh, config);
    world.route = makeRoute();
    world.traffic = {true, 9, 14, 0};  // what comes along a street may be the body itself, later
    return world;
}
}  // namespace taut::simulation
