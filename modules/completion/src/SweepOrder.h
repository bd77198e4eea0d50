#pragma once

#include <vector>

#include "taut/core/Scan.h"

namespace taut
{
/** What the order of a sweep's points tells. */
enum class PointOrder
{
    None,         //!< nothing
    InTime,       //!< as measured: once around
    LaserByLaser  //!< one laser after the other, each once around
};

/** How the azimuth goes on along the points of a sweep. */
struct SweepOrder
{
    PointOrder kind = PointOrder::None;
    double sense = 1;            //!< +1 if the azimuth grows, -1 if it falls
    double first = 0;            //!< [rad] azimuth at which it begins
    std::vector<double> turned;  //!< [rad] from `first` to each point, in the sense
};

/** [rad] of a point in the frame of the sensor. */
double azimuthOf(const LidarPoint& point);

/** An angle between -pi and pi [rad]. */
double wrapped(double angle);

/** `stagger`: by how much the lasers of each ring look aside of the first, in the sense of growing
 * azimuth [rad]; empty if they do not. Lasers are told apart by their rings: without rings, no
 * order laser by laser. */
SweepOrder orderOf(const Scan& scan, const std::vector<double>& stagger = {});
}  // namespace taut
