#pragma once

#include <optional>

#include "taut/odometry/ScanProblem.h"
#include "taut/preintegration/Initializer.h"

namespace taut
{
/** A body that rested when the estimation began, until IMU or LiDAR tells that it has left.
 *
 * While the rest lasts that the Initializer found, the body is where it was, within a standard
 * deviation. After it, the body may turn slowly in place: it is no further away than a lever times
 * the angle that it turned by, and no faster than the lever times its rate. This is a weak
 * statement: it decides where neither sensor sees (a view of the floor alone, a poor IMU), and
 * nothing elsewhere.
 */
class Rest
{
 public:
    Rest() = default;

    /** A rest that lasted for `initialization.rest_duration` from its state on; none if the body
     * was not at rest. */
    Rest(const Initialization& initialization, const InitializationConfig& config);

    /** What is known of the state that is predicted, with its covariance, at an angular rate
     * [rad/s] since the last one. The rest is over where the IMU contradicts. */
    MotionPrior at(
        const NavState& predicted, const NavState::Matrix& covariance, double angular_rate);

    /** How far the LiDAR sees the body away from where it rests. */
    struct Displacement
    {
        double moved = 0;   //!< [m]
        double turned = 0;  //!< [rad]
    };

    /** Ends the rest where a state contradicts along directions that the LiDAR tells. Gives by how
     * much, if the IMU had found the body at rest then. */
    std::optional<Displacement> endIfLeft(
        const NavState& state, const NavState::Matrix& lidar_information);

 private:
    bool lasts_ = false;  //!< at least in place
    Time end_ = 0;        //!< of the rest that the Initializer found
    MotionPrior prior_;   //!< of the last state
    double lever_ = 0;    //!< [m]
    double reach_ = 0;    //!< [m] from the place of the rest, once it has ended
};
}  // namespace taut
