#include <array>
#include <cmath>
#include <limits>

#include "Plants.h"
#include "Worlds.h"

namespace taut::simulation
{
namespace
{
constexpr double kHalf = 50;  // the forest spans [-kHalf, kHalf] in x and y

/** Smooth uneven ground: hills, mounds and bumps as sums of waves in random directions. */
class Ground
{
 public:
    explicit Ground(Random& random)
    {
        for (std::size_t i = 0; i < waves_.size(); i++)
        {
            const double length = kLengths[i % kLengths.size()] * random.uniform(0.75, 1.3);
            const double angle = random.uniform(0, 2 * M_PI);
            waves_[i] = {
                2 * M_PI / length * std::cos(angle), 2 * M_PI / length * std::sin(angle),
                random.uniform(0, 2 * M_PI), kSteepness * length};
        }
    }
    double height(double x, double y) const
    {
        double z = 0;
        for (const Wave& w : waves_) z += w.amplitude * std::sin(w.kx * x + w.ky * y + w.phase);
        return z;
    }

 private:
    struct Wave
    {
        double kx, ky, phase, amplitude;
    };
    static constexpr double kSteepness = 0.011;  // amplitude over wave length
    static constexpr std::array<double, 6> kLengths{60, 35, 20, 11, 5, 2.5};
    std::array<Wave, 18> waves_{};
};

/** A bent ring through the forest. */
std::vector<Vector3d> path(const Ground& ground)
{
    std::vector<Vector3d> points;
    for (int i = 0; i < 360; i++)
    {
        const double angle = 2 * M_PI * i / 360;
        const double radius = 27 + 5 * std::sin(3 * angle) + 3 * std::sin(5 * angle + 1);
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        points.emplace_back(x, y, ground.height(x, y));
    }
    return points;
}

double distanceTo(const std::vector<Vector3d>& points, double x, double y)
{
    double best = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : points) best = std::min(best, std::hypot(p.x() - x, p.y() - y));
    return best;
}

void addUndergrowth(
    Mesh& mesh, const Ground& ground, const std::vector<Vector3d>& way, Random& random)
{
    for (int i = 0; i < 260; i++)
    {
        const double x = random.uniform(-kHalf, kHalf), y = random.uniform(-kHalf, kHalf);
        if (distanceTo(way, x, y) < 1.8) continue;
        const Vector3d foot(x, y, ground.height(x, y));
        const double kind = random.uniform();
        if (kind < 0.65)
        {
            addLeaves(mesh, foot + Vector3d(0, 0, 0.35), {0.6, 0.6, 0.35}, 40, 0.2, random);
        }
        else if (kind < 0.85)  // rock
        {
            const double r = random.uniform(0.25, 0.8);
            addFrustum(
                mesh, foot - Vector3d(0, 0, 0.2), foot + Vector3d(0.1, 0, 0.8 * r), r, 0.5 * r, 7,
                0.5F);
        }
        else  // fallen trunk
        {
            const double angle = random.uniform(0, 2 * M_PI), length = random.uniform(2, 5);
            const double ex = x + length * std::cos(angle), ey = y + length * std::sin(angle);
            if (distanceTo(way, ex, ey) < 1.8 || distanceTo(way, (x + ex) / 2, (y + ey) / 2) < 1.8)
                continue;
            addFrustum(
                mesh, foot + Vector3d(0, 0, 0.15), {ex, ey, ground.height(ex, ey) + 0.1}, 0.2, 0.15,
                12, 0.35F);
        }
    }
}
}  // namespace

World makeForest(Random& random)
{
    World world;
    const Ground ground(random);
    addGround(
        world.mesh, -kHalf, -kHalf, kHalf, kHalf, 0.4,
        [&ground](double x, double y) { return ground.height(x, y); }, 0.4F);
    world.mesh.mark(0, Material::Soil);
    const std::vector<Vector3d> way = path(ground);
    std::vector<Vector3d> feet;
    for (int tries = 0; tries < 2500 && feet.size() < 620; tries++)
    {
        const double x = random.uniform(-kHalf, kHalf), y = random.uniform(-kHalf, kHalf);
        if (distanceTo(way, x, y) < 2.4 || distanceTo(feet, x, y) < 2.0) continue;
        feet.emplace_back(x, y, ground.height(x, y));
        const double height = random.uniform(8, 16);
        addTree(
            world.mesh, feet.back(),
            {height, random.uniform(0.1, 0.32), random.uniform(0.45, 0.6) * height,
             random.uniform(0.9, 1.5), 50},
            random);
    }
    addUndergrowth(world.mesh, ground, way, random);
    world.route.corners = way;
    world.route.rounding = 3;
    world.traffic.oncoming = 1.2;
    return world;
}
}  // namespace taut::simulation
