#include "taut/simulation/Scene.h"

#include <algorithm>
#include <cmath>

#include "Plants.h"
#include "taut/simulation/MotionGenerator.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
Mesh person(Random& random)
{
    Mesh mesh;
    const double height = random.uniform(1.55, 1.9), width = random.uniform(0.17, 0.23);
    for (const double y : {-0.1, 0.1})
        addFrustum(mesh, {0, y, 0}, {0, y, 0.48 * height}, 0.07, 0.09, 10, 0.3F);
    addFrustum(mesh, {0, 0, 0.46 * height}, {0, 0, 0.84 * height}, 0.85 * width, width, 14, 0.5F);
    addFrustum(mesh, {0, 0, 0.86 * height}, {0, 0, height}, 0.09, 0.08, 12, 0.4F);
    return mesh;
}

Mesh car(Random& random)
{
    Mesh mesh;
    addCar(mesh, Pose{}, static_cast<float>(random.uniform(0.15, 0.7)), random.uniform(0.95, 1.1));
    return mesh;
}
}  // namespace

Mover::Mover(Mesh mesh, Motion motion) : caster_(std::move(mesh)), motion_(std::move(motion))
{
    for (const Vector3d& v : caster_.mesh().vertices) radius_ = std::max(radius_, v.norm());
}

std::optional<Hit> Mover::cast(
    double t, const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    const Pose T = motion_.poseAt(t);
    const Vector3d to_mover = T.p - origin;
    const double along = to_mover.dot(direction);
    const double aside2 = to_mover.squaredNorm() - along * along;
    if (along < -radius_ || along > max_range + radius_ || aside2 > radius_ * radius_) return {};
    const Pose T_mover_world = T.inverse();
    auto hit = caster_.cast(T_mover_world * origin, T_mover_world.R * direction, max_range);
    if (hit) hit->normal = T.R * hit->normal;
    return hit;
}

std::optional<Hit> Scene::cast(
    double t, const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    auto nearest = world.cast(origin, direction, max_range);
    for (const Mover& mover : movers)
    {
        const auto hit = mover.cast(t, origin, direction, nearest ? nearest->range : max_range);
        if (hit) nearest = hit;
    }
    return nearest;
}

std::vector<Mover> makeTraffic(
    const Traffic& traffic, const Course& course, int count, std::uint64_t seed)
{
    Random random(seed, 3);
    std::vector<Mover> movers;
    double ahead = 0;
    for (int k = 0; k < count; k++)
    {
        const bool oncoming = traffic.oncoming > 0 && k % 2 == 1;
        ahead += traffic.spacing * random.uniform(1.0, 1.6);
        const double distance = k % 4 < 2 ? ahead : -ahead;
        const double place = random.uniform() * course.path.length();
        const double speed = traffic.speed * random.uniform(0.7, 1.2);
        std::vector<Pose> controls;
        for (std::size_t i = 0; i < course.times.size(); i++)
        {
            const double s =
                oncoming ? place - speed * course.times[i] : course.lengths[i] + distance;
            Pose T;
            T.R = expSO3(Vector3d(0, 0, course.path.heading(s) + (oncoming ? M_PI : 0)));
            // To the left of the route, which is to the right of who comes along it.
            T.p = course.path.position(s);
            if (oncoming) T.p -= T.R * Vector3d(0, traffic.oncoming, 0);
            controls.push_back(T);
        }
        movers.emplace_back(
            traffic.cars ? car(random) : person(random), alongCourse(course, controls));
    }
    return movers;
}
}  // namespace taut::simulation
