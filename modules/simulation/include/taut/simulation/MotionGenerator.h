#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/Config.h"
#include "taut/simulation/Course.h"
#include "taut/simulation/Motion.h"
#include "taut/simulation/Replay.h"

namespace taut::simulation
{
enum class MotionPreset
{
    Calm,     //!< carried slowly, up to 1 rad/s
    Walk,     //!< 1.2 m/s, with steps
    Fast,     //!< carried in a hurry, up to 3 rad/s
    Violent,  //!< shaken, up to 8 rad/s and 75 rad/s^2
    Vehicle,  //!< up to 15 m/s
    Flight,   //!< a multicopter: leans into its accelerations
    Replay,   //!< a recorded trajectory
};

/** How a body moves along its route. The presets are sets of these numbers. */
struct MotionConfig
{
    MotionPreset type = MotionPreset::Walk;
    double height = 1.4;            //!< of the body over the route [m]
    SpeedLimits limits;             //!< along the route
    double start = 0;               //!< where on the route, 0..1 of its length
    double sway = 0;                //!< peak of the wandering beside the route, each axis [m]
    double sway_frequency = 0.5;    //!< highest, of the wandering [Hz]
    double shake_rate = 0;          //!< peak angular rate; 0 = no shaking [rad/s]
    double shake_acceleration = 1;  //!< peak angular acceleration [rad/s^2]
    double step_frequency = 0;      //!< 0 = no steps [Hz]
    double step_height = 0;         //!< half of the up and down of a step [m]
    double climb = 0;               //!< amplitude of slow rising and falling [m]
    double climb_period = 20;       //!< [s]
    double lean = 0;  //!< tilt into the acceleration: 1 = thrust along body z, < 0 = springs
    double knot_spacing = 0.02;  //!< of the spline [s]
    ReplayConfig replay;         //!< for type Replay, which takes none of the above but the spacing
};

MotionConfig motionPreset(MotionPreset preset);

/** Reads `type` and then the keys that override the preset of that type. */
void declare(ConfigSection& section, MotionConfig& config);

/** The course of a body along a route: at rest until `rest` [s] (0: in motion from the first moment
 * on). */
Course makeCourse(const MotionConfig& config, const Route& route, double duration, double rest);

/** The motion along a course, with all that makes it shake and sway. Deterministic in the seed. */
Motion makeMotion(const MotionConfig& config, const Course& course, std::uint64_t seed);

/** The spline through poses given at the times of a course. */
Motion alongCourse(const Course& course, const std::vector<Pose>& controls);

/** Largest angular rate and acceleration of a motion. */
struct MotionPeaks
{
    double rate = 0;                  //!< [rad/s]
    double angular_acceleration = 0;  //!< [rad/s^2]
    double speed = 0;                 //!< [m/s]
    double acceleration = 0;          //!< [m/s^2]
};
MotionPeaks peaksOf(const Motion& motion);
}  // namespace taut::simulation
