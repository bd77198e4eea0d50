#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Imu.h"
#include "taut/core/NavState.h"
#include "taut/core/Warning.h"

namespace taut
{
/** What to do when the body moves before it has rested for long enough. */
enum class OnMotion
{
    Start,  //!< start in motion, with a prior that says how little is known
    Wait,   //!< drop everything before the next rest
};

struct InitializationConfig
{
    double rest_duration = 10.0;  //!< [s] rest that is waited for (paper, section II-D)
    double min_rest = 0.5;        //!< [s] a shorter rest than asked for is used down to this
    OnMotion on_motion = OnMotion::Start;

    // Rest: the means over windows agree. Vibration does not disturb means.
    double window = 0.25;            //!< [s]
    double max_rate_change = 0.02;   //!< [rad/s] between means of windows
    double max_accel_change = 0.15;  //!< [m/s^2] between means of windows
    double max_gyro_bias = 0.1;      //!< [rad/s] a steady rate above this is motion, not a bias
    double gravity_tolerance = 0.8;  //!< [m/s^2] of the mean specific force from 9.81

    // How far a body at rest moves: a lever times the furthest that it turns, within bounds. A rest
    // that motion cuts short may end in a part of that motion: it sways as far as any.
    double sway_lever = 0.5;  //!< [m]
    double min_sway = 2e-3;   //!< [m]
    double max_sway = 0.02;   //!< [m]

    // Prior of the biases, one standard deviation.
    double accel_bias_sigma = 0.1;  //!< [m/s^2]
    double gyro_bias_sigma = 0.02;  //!< [rad/s]

    // Prior of a start in motion, one standard deviation.
    double moving_tilt_sigma = 0.15;     //!< [rad]
    double moving_velocity_sigma = 2.0;  //!< [m/s]

    void declare(ConfigSection& section);
};

/** Where the estimation starts from. */
struct Initialization
{
    NavEstimate estimate;  //!< state at the start of the rest (or of the data), with its covariance
    bool at_rest = true;
    double rest_duration = 0;   //!< [s] of data used
    double position_sigma = 0;  //!< [m] how far from the origin the body may be while it rests
    ImuNoise measured_noise;    //!< white noise densities seen at rest; 0 if not at rest
};

/** Waits for a rest and takes gravity direction and biases from it (paper, section II-D; method
 * sheet, initialisation). Roll and pitch come from the mean specific force, yaw is 0; what
 * exceeds 9.81 m/s^2 is a bias of the accelerometer along gravity; tilt and accelerometer bias are
 * correlated in the covariance, as they are in truth. */
class Initializer
{
 public:
    Initializer(const InitializationConfig& config, WarningSink warn);

    /** Takes the next sample; true as soon as there is a result. */
    bool add(const ImuSample& sample);

    /** No more samples: makes the best of what there is. False if there was nothing, or if a rest
     * was to be waited for and none came. */
    bool finish();

    const std::optional<Initialization>& result() const { return result_; }

    /** No start that is still to be found lies before this time; nothing before the first sample.
     */
    std::optional<Time> earliestStart() const;

 private:
    struct Window
    {
        Time begin = 0, end = 0;
        int count = 0;
        Vector3d gyro_sum = Vector3d::Zero(), accel_sum = Vector3d::Zero();
        Vector3d gyro_square = Vector3d::Zero(), accel_square = Vector3d::Zero();

        void add(const ImuSample& s);
        void add(const Window& w);
        Vector3d gyroMean() const { return gyro_sum / count; }
        Vector3d accelMean() const { return accel_sum / count; }
    };

    void closeWindow();
    bool restedFully() const;
    bool continuesRest(const Window& w) const;
    /** Standard deviation, per axis, of the means of the rest's windows: rate and force. */
    std::pair<Vector3d, Vector3d> spreadOfRest() const;
    bool plausibleRest(const Window& w) const;
    void onMotion(Time t);
    void startInMotion(Time t, double rested);
    void reportWaiting(Time t, double rested);
    Initialization fromRest() const;
    double swayAtRest() const;
    Initialization fromMotion() const;

    InitializationConfig config_;
    WarningSink warn_;
    Window current_, first_, rest_;
    std::vector<Window> rests_;  //!< the windows of rest_
    bool waiting_reported_ = false;
    std::optional<Initialization> result_;
};
}  // namespace taut
