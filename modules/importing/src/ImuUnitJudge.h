#pragma once

#include <string>

#include "taut/core/Imu.h"

namespace taut
{
/** Units that an IMU's values seem to have: factors to m/s^2 and rad/s, and how that was told. */
struct ImuUnits
{
    double accel_scale = 1, gyro_scale = 1;
    bool accel_fits = true;  //!< false: the specific force is near gravity in no unit
    std::string accel_name = "m/s^2", gyro_name = "rad/s";
    std::string accel_reason, gyro_reason;
};

/** Judges the units of an IMU by gravity: the norm of the specific force, and which unit of the
 * rates turns gravity as the accelerometer saw it turn within a second. */
class ImuUnitJudge
{
 public:
    /** [rad/s]; gyros end at 35 (2000 deg/s) or 70 (4000 deg/s). */
    static constexpr double kFastestRate = 80;

    /** A sample as read, in the order of time. */
    void add(const ImuSample& sample);

    /** As of now. */
    ImuUnits units() const;

 private:
    void closeWindow();
    double accelScale() const;
    double meanForce() const { return samples_ ? force_ / static_cast<double>(samples_) : 0; }

    ImuSamples window_;
    std::size_t samples_ = 0;
    double force_ = 0;                               // sum of norms
    std::size_t too_fast_ = 0;                       // samples, for rad/s
    std::size_t seconds_rad_ = 0, seconds_deg_ = 0;  // that speak for the unit
};
}  // namespace taut
