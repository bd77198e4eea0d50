#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "taut/odometry/Odometry.h"

namespace taut
{
/** Scans that a start in motion looks at. */
constexpr std::size_t kStartingScans = 10;

/** Where an estimation can start in motion. */
struct StartInMotion
{
    Initialization start;
    bool converged = true;  //!< the first scans agree on its velocity and on gravity
};

/** The results of the first scans from a start. */
using FirstScans = std::function<std::vector<ScanResult>(const Initialization&)>;

/** In motion, the first scan is undistorted with an unknown velocity and makes a wrong map, and the
 * mean specific force is not gravity. The scans after it tell both: passes over the first scans
 * begin again with what they told, until map and motion agree. Where few features match, passes
 * from other velocities are tried too, and the best start is taken. */
StartInMotion findStartInMotion(
    const Initialization& initialization, const FirstScans& first_scans);
}  // namespace taut
