#pragma once

#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** Specific force, in the world frame, of an accelerometer at rest [m/s^2]: upwards. */
inline const Vector3d kGravityWorld{0, 0, 9.81};

/** One reading of the IMU, in the body frame b (the IMU's own). */
struct ImuSample
{
    Time t = 0;
    Vector3d gyro = Vector3d::Zero();   //!< angular rate [rad/s]
    Vector3d accel = Vector3d::Zero();  //!< specific force [m/s^2]; at rest R^T g, upwards
    // Standard deviation of what a reading beyond the sensor's range hides; 0: within it.
    double gyro_hidden = 0;   //!< [rad/s]
    double accel_hidden = 0;  //!< [m/s^2]
};

using ImuSamples = std::vector<ImuSample>;  //!< strictly increasing in time

/** Continuous-time noise of an IMU (paper, equation 2). The white noise is that of a good IMU, to
 * be raised by what is seen at rest. What a sensor does wrong besides is left to biases that may
 * move.
 */
struct ImuNoise
{
    double gyro = 2e-4;             //!< white noise density [rad/s/sqrt(Hz)]
    double accel = 2e-3;            //!< white noise density [m/s^2/sqrt(Hz)]
    double gyro_bias_walk = 5e-4;   //!< [rad/s^2/sqrt(Hz)]
    double accel_bias_walk = 5e-3;  //!< [m/s^3/sqrt(Hz)]
};
}  // namespace taut
