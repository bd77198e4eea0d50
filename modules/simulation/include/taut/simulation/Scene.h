#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "taut/simulation/Course.h"
#include "taut/simulation/Motion.h"
#include "taut/simulation/RayCaster.h"
#include "taut/simulation/World.h"

namespace taut::simulation
{
/** A rigid body that goes its own way. */
class Mover
{
 public:
    /** `mesh` in the mover's own frame. */
    Mover(Mesh mesh, Motion motion);

    /** As RayCaster::cast(), at time t [s]. */
    std::optional<Hit> cast(
        double t, const Vector3d& origin, const Vector3d& direction, double max_range) const;

    const Motion& motion() const { return motion_; }
    double radius() const { return radius_; }  //!< around the origin of its frame [m]

 private:
    RayCaster caster_;
    Motion motion_;
    double radius_ = 0;
};

/** Leaves that sway together in the wind. */
class Foliage
{
 public:
    /** @param phases of the sinusoids along x and y [rad] */
    Foliage(Mesh leaves, const Wind& wind, const Eigen::Vector2d& phases);

    /** Where the leaves are at time t [s], from where they rest [m]. */
    Vector3d sway(double t) const;

    /** As RayCaster::cast(), at time t [s]. */
    std::optional<Hit> cast(
        double t, const Vector3d& origin, const Vector3d& direction, double max_range) const;

 private:
    RayCaster caster_;
    Wind wind_;
    Eigen::Vector2d phases_;
};

/** Takes the leaves out of a world and puts them in the wind. Cells of 4 m alternate between four
 * parts, each with phases of its own. */
std::vector<Foliage> takeLeaves(Mesh& world, const Wind& wind, std::uint64_t seed);

/** What there is to be seen: a world at rest, and whatever moves in it. */
struct Scene
{
    RayCaster world;
    std::vector<Mover> movers;
    std::vector<Foliage> foliage{};
    Texture texture{};  //!< of the world at rest

    /** The first surface along a ray at time t [s]. What a mirror shows lies behind it, on the
     * straight ray. */
    std::optional<Hit> cast(
        double t, const Vector3d& origin, const Vector3d& direction, double max_range) const;

 private:
    std::optional<Hit> nearest(
        double t, const Vector3d& origin, const Vector3d& direction, double max_range) const;
    void roughen(Hit& hit, double t, const Vector3d& origin, const Vector3d& direction) const;
};

/** People or cars, as the world has them: every other one goes along with the body, a few metres
 * ahead or behind; the others come towards it beside the route, where there is room for that. They
 * rest while the body does not move only if they go along with it. */
std::vector<Mover> makeTraffic(
    const Traffic& traffic, const Course& course, int count, std::uint64_t seed);

/** People who walk with the body, before and beside it, at its speed. They wander by a tenth of
 * their distance, at rest too. */
std::vector<Mover> makeCompanions(
    const Companions& companions, const Course& course, std::uint64_t seed);
}  // namespace taut::simulation
