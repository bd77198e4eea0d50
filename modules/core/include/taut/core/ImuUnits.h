#pragma once

#include <string>

#include "taut/core/Imu.h"

namespace taut
{
inline constexpr double kDegree = 0.017453292519943295;  //!< [rad]

/** [rad/s] No gyro reads more: they end at 35 (2000 deg/s) or 70 (4000 deg/s). */
inline constexpr double kFastestRate = 80;

/** A unit as a recording seems to have it. */
struct Unit
{
    std::string name;   //!< "m/s^2"; "unknown"
    double factor = 1;  //!< to SI; 1 where unknown

    bool known() const { return name != "unknown"; }
};

/** The unit in which `mean_force`, the mean norm of the specific force over a second or more, is
 * near gravity: m/s^2, g, milli-g or unknown. */
Unit accelUnit(double mean_force);

/** Units of an IMU's values and how they were told. */
struct ImuUnits
{
    Unit accel{"m/s^2", 1}, gyro{"rad/s", 1};
    std::string accel_reason, gyro_reason;
};

/** Judges the units of an IMU by gravity: the norm of the specific force, and which unit of the
 * rates turns gravity as the accelerometer saw it turn within a second. A turn about the vertical
 * tells nothing. Holds one second of samples. */
class ImuUnitJudge
{
 public:
    /** A sample as read, in the order of time. */
    void add(const ImuSample& sample);

    /** As of now; in SI where nothing speaks against it. */
    ImuUnits units() const;

    /** Whether the rates are in deg/s, as of now. */
    bool gyroInDegrees() const;

    /** Whether rates came that no gyro reads in rad/s, more often than by mistake. */
    bool tooFastForRadians() const;

    /** Mean norm of the specific force so far, in the recording's unit; 0 without samples. */
    double meanForce() const { return samples_ ? force_ / static_cast<double>(samples_) : 0; }

 private:
    void closeWindow();
    bool showsGravity(const Unit& unit) const;

    ImuSamples window_;
    std::size_t samples_ = 0;
    double force_ = 0;          // sum of norms
    double steady_ = 0;         // of what stays of the force while the body turns, by second
    std::size_t seconds_ = 0;   // that told it
    std::size_t too_fast_ = 0;  // samples, for rad/s
    std::size_t seconds_rad_ = 0, seconds_deg_ = 0;  // that speak for the unit
};
}  // namespace taut
