#pragma once

#include <vector>

#include "taut/simulation/Route.h"

namespace taut::simulation
{
/** When a body is where along a route: sampled in uniform steps, from rest up to the speed that the
 * route allows. */
struct Course
{
    /** Smoothing reaches so far in time [s]: it falters over this span at the end of the samples.
     */
    static constexpr double kRunOut = 1.5;

    /** A course that covers [0, duration] and kRunOut more. The body rests until `rest`; with 0 it
     * has long been moving. `start` is its place at first, 0 to 1 of the route. */
    Course(
        const Route& route, const SpeedLimits& limits, double start, double duration, double rest,
        double spacing);

    RoutePath path;
    double spacing;             //!< of the samples [s]
    double departure = 0;       //!< when the first movement of whatever kind may begin [s]
    std::vector<double> times;  //!< [s]; the first are negative
    std::vector<double>
        lengths;  //!< along the route, smooth in time [m]; grows by path.length() a lap
};
}  // namespace taut::simulation
