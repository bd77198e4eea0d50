#pragma once

#include "taut/simulation/Simulator.h"

namespace taut::simulation::test
{
/** A room of 12 x 10 x 4 m with a box in it, and a way around the box. */
inline World smallWorld()
{
    World world;
    addRoom(world.mesh, {0, 0, 0}, {12, 10, 4}, 0.5F);
    addStandingBox(world.mesh, {6, 5, 0}, {2, 1.5, 1.8}, 0.3, 0.7F);
    world.route.corners = {{2.5, 2.5, 0}, {9.5, 2.5, 0}, {9.5, 7.5, 0}, {2.5, 7.5, 0}};
    world.route.rounding = 2;
    return world;
}

inline Motion motionOf(
    MotionPreset preset, double duration, double rest = 2, std::uint64_t seed = 7)
{
    const MotionConfig config = motionPreset(preset);
    return makeMotion(config, makeCourse(config, smallWorld().route, duration, rest), seed);
}

inline Scene smallScene()
{
    return {RayCaster(smallWorld().mesh), {}};
}

inline const std::vector<MotionPreset> kMovingPresets{MotionPreset::Calm,    MotionPreset::Walk,
                                                      MotionPreset::Fast,    MotionPreset::Violent,
                                                      MotionPreset::Vehicle, MotionPreset::Flight};
}  // namespace taut::simulation::test
