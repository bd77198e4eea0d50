#pragma once

#include <vector>

#include "taut/core/PoseGraph.h"

namespace taut
{
/** The gap of a loop before it was closed, with what was expected of it. */
struct ClosedGap
{
    Vector6d gap;          //!< d of T_odometry Exp(d) = T_loop [m, rad]
    Matrix6d of_odometry;  //!< covariance of the relative pose along the path
    Matrix6d information;  //!< of the loop; zero in directions that it does not show
};

/** By which factor the covariance of the odometry has to be multiplied so that the gaps are as
 * likely as they can be, 0.01 to 100: how far an odometry drifts depends on the sensor, and its
 * loops tell. Without gaps 1. Many gaps of one place are few pieces of evidence, so that all
 * together count as six at most, against a guess of 1 that may be wrong by a factor of 20.
 *
 * Maximises sum of log N(gap; 0, k C + Lambda^-1) + log prior(log k), on a grid. */
double driftScale(const std::vector<ClosedGap>& gaps);
}  // namespace taut
