#pragma once

#include <functional>

#include "Movables.h"
#include "taut/simulation/Mesh.h"
#include "taut/simulation/Random.h"

/** \file StreetSide.h
 * One side of a street: sidewalk, facades, parked cars, poles and trees. Distances are from the
 * middle line of the street [m]. */
namespace taut::simulation
{
inline constexpr double kLane = 1.9;     // middle of the driven lane
inline constexpr double kParking = 4.9;  // middle of the parked cars
inline constexpr double kKerb = 6, kFacade = 9.5;

using Terrain = std::function<double(double x, double y)>;  // height of the ground [m]

struct StreetSide
{
    Vector3d start, along, out;  // out: from the middle of the street to the facades
    double length;
    Terrain height;

    Vector3d at(double s, double distance) const;
    /** Frame with z up and y away from the street; x is along the side or against it. */
    Pose frame(double s, double distance) const;
};

/** The sides of a street that goes counter-clockwise around a block, from corner to corner of the
 * middle lines: away from the block, and that of the block itself. */
StreetSide outerSide(const Vector3d& from, const Vector3d& to, const Terrain& height);
StreetSide innerSide(const Vector3d& from, const Vector3d& to, const Terrain& height);

/** All that stands there, but the cars: they are added to `cars`. */
void addStreetSide(Mesh& mesh, const StreetSide& side, Movables& cars, Random& random);
}  // namespace taut::simulation
