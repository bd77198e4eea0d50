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

/** What there is to be seen: a world at rest, and whatever moves in it. */
struct Scene
{
    RayCaster world;
    std::vector<Mover> movers;

    /** The first surface along a ray at time t [s]. */
    std::optional<Hit> cast(
        double t, const Vector3d& origin, const Vector3d& direction, double max_range) const;
};

/** People or cars, as the world has them: every other one goes along with the body, a few metres
 * ahead or behind; the others come towards it beside the route, where there is room for that. They
 * rest while the body does not move only if they go along with it. */
std::vector<Mover> makeTraffic(
    const Traffic& traffic, const Course& course, int count, std::uint64_t seed);
}  // namespace taut::simulation
