#include "taut/simulation/Scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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

/** Normal of variance 1 at every place, smooth over texture.roughness_length. */
double heightAt(const Texture& texture, const Vector3d& place)
{
    const Vector3d scaled = place / texture.roughness_length;
    const Vector3d corner = scaled.array().floor();
    const Vector3d within = scaled - corner;
    double sum = 0, squares = 0;
    for (int i = 0; i < 8; i++)
    {
        double weight = 1;
        std::uint64_t index = 0;
        for (int axis = 0; axis < 3; axis++)
        {
            const int upper = i >> axis & 1;
            weight *= upper == 1 ? within[axis] : 1 - within[axis];
            const auto cell = static_cast<std::int64_t>(corner[axis]) + upper;
            index = index * 0x1000003 + static_cast<std::uint64_t>(cell);
        }
        sum += weight * Random(texture.seed, 40, index).normal();
        squares += weight * weight;
    }
    return sum / std::sqrt(squares);
}

/** A random number of one ray at one time, in [0, 1). */
double rayLuck(std::uint64_t seed, double t, const Vector3d& direction)
{
    std::array<std::uint64_t, 3> bits{};
    const std::array<double, 3> values{t, direction.x(), direction.y()};
    std::memcpy(bits.data(), values.data(), sizeof(bits));
    return Random(seed ^ bits[0], 41 + bits[1], bits[2]).uniform();
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

std::optional<Hit> Scene::nearest(
    double t, const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    auto nearest = world.cast(origin, direction, max_range);
    if (nearest && (texture.roughness > 0 || texture.grass > 0))
        roughen(*nearest, t, origin, direction);
    for (const Mover& mover : movers)
    {
        const auto hit = mover.cast(t, origin, direction, nearest ? nearest->range : max_range);
        if (hit) nearest = hit;
    }
    for (const Foliage& leaves : foliage)
    {
        const auto hit = leaves.cast(t, origin, direction, nearest ? nearest->range : max_range);
        if (hit) nearest = hit;
    }
    return nearest;
}

std::optional<Hit> Scene::cast(
    double t, const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    constexpr int bounces = 3;
    constexpr double clear = 1e-3;   // of the mirror that the light comes from [m]
    constexpr float silver = 0.81F;  // of the light is left, there and back
    auto hit = nearest(t, origin, direction, max_range);
    if (!hit || hit->material != Material::Mirror) return hit;

    std::vector<Vector3d> mirrors;  // their normals
    Vector3d from = origin, along = direction;
    double length = 0;
    float light = 1;
    while (hit && hit->material == Material::Mirror)
    {
        if (mirrors.size() == bounces) return {};
        mirrors.push_back(hit->normal);
        from += hit->range * along;
        along -= 2 * along.dot(hit->normal) * hit->normal;
        from += clear * along;
        length += hit->range + clear;
        light *= silver;
        hit = nearest(t, from, along, max_range - length);
    }
    if (!hit) return {};
    hit->range += length;
    hit->reflectivity *= light;
    for (auto normal = mirrors.rbegin(); normal != mirrors.rend(); ++normal)
        hit->normal -= 2 * hit->normal.dot(*normal) * *normal;
    return hit;
}

void Scene::roughen(Hit& hit, double t, const Vector3d& origin, const Vector3d& direction) const
{
    constexpr double least_range = 1e-3;  // [m]
    const double cosine = -hit.normal.dot(direction);
    const bool rough = hit.material == Material::Solid || hit.material == Material::Soil;
    if (texture.roughness > 0 && rough)
    {
        // As seen along the ray; a grazing one does not see behind the heights.
        const double height = texture.roughness * heightAt(texture, origin + hit.range * direction);
        hit.range = std::max(hit.range - height / std::max(cosine, 0.2), least_range);
    }
    if (texture.grass <= 0 || hit.material != Material::Soil) return;
    // Light is met by blades at random along its way through the grass (Beer and Lambert).
    const double through = std::min(texture.grass / cosine, hit.range - least_range);
    const double way = -texture.grass_path * std::log(1 - rayLuck(texture.seed, t, direction));
    if (way >= through) return;
    hit.range += way - through;
    hit.normal = -direction;
    hit.reflectivity = 0.45F;
    hit.material = Material::Leaf;
}

Foliage::Foliage(Mesh leaves, const Wind& wind, const Eigen::Vector2d& phases)
    : caster_(std::move(leaves)), wind_(wind), phases_(phases)
{
}

Vector3d Foliage::sway(double t) const
{
    const double angle = 2 * M_PI * wind_.frequency * t;
    return {
        wind_.sway * std::sin(angle + phases_.x()), wind_.sway * std::sin(angle + phases_.y()), 0};
}

std::optional<Hit> Foliage::cast(
    double t, const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    return caster_.cast(origin - sway(t), direction, max_range);
}

std::vector<Foliage> takeLeaves(Mesh& world, const Wind& wind, std::uint64_t seed)
{
    constexpr double cell = 4;  // [m]
    constexpr std::size_t parts = 4;
    std::array<Mesh, parts> leaves;
    Mesh rest;
    rest.vertices = world.vertices;
    for (std::size_t i = 0; i < world.triangles.size(); i++)
    {
        const Mesh::Triangle& corners = world.triangles[i];
        Mesh* to = &rest;
        Mesh::Triangle triangle = corners;
        if (world.materialOf(i) == Material::Leaf)
        {
            const Vector3d& p = world.vertices[corners[0]];
            const auto x = static_cast<long>(std::floor(p.x() / cell));
            const auto y = static_cast<long>(std::floor(p.y() / cell));
            to = &leaves[static_cast<std::size_t>(x + 2 * y) % parts];
            const auto first = static_cast<std::uint32_t>(to->vertices.size());
            for (const std::uint32_t corner : corners)
                to->vertices.push_back(world.vertices[corner]);
            triangle = {first, first + 1, first + 2};
        }
        to->triangles.push_back(triangle);
        to->reflectivity.push_back(world.reflectivity[i]);
        to->materials.push_back(world.materialOf(i));
    }
    std::vector<Foliage> all;
    Random random(seed, 8);
    for (Mesh& part : leaves)
    {
        const double along_x = random.uniform(0, 2 * M_PI), along_y = random.uniform(0, 2 * M_PI);
        if (!part.triangles.empty())
            all.emplace_back(std::move(part), wind, Eigen::Vector2d(along_x, along_y));
    }
    world = std::move(rest);
    return all;
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

std::vector<Mover> makeCompanions(
    const Companions& companions, const Course& course, std::uint64_t seed)
{
    std::vector<Mover> movers;
    for (int k = 0; k < companions.ahead + companions.beside; k++)
    {
        Random random(seed, 7, static_cast<std::uint64_t>(k));
        const bool ahead = k < companions.ahead;
        const int number = ahead ? k : k - companions.ahead;
        const double distance =
            ahead ? companions.distance * (1 + number) : companions.distance / 2 * (1 + number / 2);
        const double side = number % 2 == 0 ? 1 : -1, wander = 0.1 * distance;
        const double along = ahead ? distance : random.uniform(-0.3, 0.3);
        const double aside = ahead ? random.uniform(-0.2, 0.2) : side * distance;
        const double frequency = random.uniform(0.1, 0.25), phase = random.uniform(0, 2 * M_PI);
        std::vector<Pose> controls;
        for (std::size_t i = 0; i < course.times.size(); i++)
        {
            const double angle = 2 * M_PI * frequency * course.times[i] + phase;
            const double s = course.lengths[i] + along + wander * std::sin(angle);
            Pose T;
            T.R = expSO3(Vector3d(0, 0, course.path.heading(s)));
            T.p = course.path.position(s) +
                  T.R * Vector3d(0, aside + wander * std::cos(0.7 * angle), 0);
            controls.push_back(T);
        }
        movers.emplace_back(person(random), alongCourse(course, controls));
    }
    return movers;
}
}  // namespace taut::simulation
