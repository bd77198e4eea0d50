#pragma once

#include <vector>

#include "taut/core/Scan.h"

namespace taut
{
/** What is to be added to the measurements of each laser of a LiDAR, by ring: its elevation [rad]
 * above the xy-plane of the sensor, and its range [m]. Both of the same size, or both empty. */
struct BeamCorrections
{
    std::vector<double> elevation, range;

    bool empty() const { return elevation.empty(); }
};

/** How a point moves with its beam, in the frame of the point. */
struct BeamDerivative
{
    Vector3d by_range;      //!< unit vector along the beam
    Vector3d by_elevation;  //!< [m/rad]
};

/** Of a point in the frame of the sensor, not on its z axis. The beam is taken to start in the
 * origin. */
BeamDerivative beamDerivative(const Vector3d& point);

/** The point (frame of the sensor) with its elevation and range changed; its azimuth stays. */
Vector3d withBeamChanged(const Vector3d& point, double elevation, double range);

/** Corrects points in the frame of the sensor. Throws std::runtime_error if the sensor has other
 * rings than the corrections. */
void correctBeams(Scan& scan, const BeamCorrections& corrections);
}  // namespace taut
