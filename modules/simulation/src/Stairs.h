#pragma once

#include "taut/simulation/Mesh.h"

/** \file Stairs.h
 * Stairs of two flights a storey. In their frame x leads from the landings on the storeys to those
 * half way up, y is across and z up; the flights lie on either side of y = 0. */
namespace taut::simulation::stairs
{
inline constexpr int kSteps = 10;                             // of a flight
inline constexpr double kRise = 0.16, kRun = 0.28;            // of a step [m]
inline constexpr double kLanding = 1.4, kFlightWidth = 1.35;  // [m]
inline constexpr double kEye = 0.2;                           // between the flights [m]
inline constexpr double kHalfStorey = kSteps * kRise, kStorey = 2 * kHalfStorey;
inline constexpr double kLength = 2 * kLanding + kSteps * kRun;
inline constexpr double kHalfWidth = kFlightWidth + kEye / 2;
inline constexpr double kSlab = 0.16;  // thickness of landings [m]

/** A flight that rises from z along +x (forward) or -x, on the side of the sign of y. */
void addFlight(Mesh& mesh, double z, bool forward, double side);

/** A landing whose upper side is at z, with its middle at x. */
void addLanding(Mesh& mesh, double z, double x);
}  // namespace taut::simulation::stairs
