#pragma once

#include <cstdint>

#include "taut/core/Geometry.h"

namespace taut
{
enum class Surface : std::uint8_t
{
    None,   //!< the map knows nothing reliable there
    Plane,  //!< direction = unit normal
    Line,   //!< direction = unit direction of the line
};

/** The part of the map that a feature was matched with (paper: n and p_0). */
struct Correspondence
{
    Surface surface = Surface::None;
    Vector3d direction = Vector3d::UnitZ();  //!< unit vector, world frame
    Vector3d point = Vector3d::Zero();       //!< a point on the surface, world frame [m]
    double sigma = 0;  //!< what the map adds to the noise of the residual: thickness and
                       //!< uncertainty of the surface at the query [m]
};
}  // namespace taut
