#pragma once

#include "taut/simulation/Mesh.h"
#include "taut/simulation/Random.h"
#include "taut/simulation/World.h"

/** \file Walls.h
 * Walls of rooms, as seen from within. */
namespace taut::simulation
{
/** Pose of a wall for addWall(): it leads from one place to another, and is seen by who walks there
 * with the wall at the left hand. */
Pose wallAlong(const Vector3d& from, const Vector3d& to);

/** A wall as wallAlong() has it. */
void addWallAlong(
    Mesh& mesh, const Vector3d& from, const Vector3d& to, double height,
    const std::vector<Recess>& recesses, float reflectivity);

/** Doors a few centimetres deep along a wall: all that a LiDAR can tell the place along a corridor
 * by. */
std::vector<Recess> makeDoors(double length, Random& random);

/** A hole of some width in the middle of `at`, from the floor up; `depth` is that of its jambs. */
Recess makeDoorway(double at, double width, double height, double depth);

/** Makes config.glass of the windows of a wall of glass that a LiDAR does not see: nothing returns
 * from there. Which ones is drawn apart from all else, for each wall by its number. */
void glaze(std::vector<Recess>& windows, const WorldConfig& config, int wall = 0);
}  // namespace taut::simulation
