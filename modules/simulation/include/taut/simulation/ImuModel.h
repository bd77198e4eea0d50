#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Imu.h"
#include "taut/simulation/Motion.h"

namespace taut::simulation
{
enum class ImuPreset
{
    Ideal,       //!< no errors at all
    Tactical,    //!< STIM300-like
    Industrial,  //!< ADIS16448-like
    Consumer,    //!< MPU-9250-like
};

/** An IMU and its errors. */
struct ImuConfig
{
    ImuPreset type = ImuPreset::Industrial;
    double rate = 200;  //!< [Hz]
    ImuNoise noise{
        2e-3, 2e-2, 1e-4, 1e-3};  //!< white noise densities and random walks of the biases
    double gyro_bias = 0;         //!< turn-on bias, standard deviation of each axis [rad/s]
    double accel_bias = 0;        //!< [m/s^2]
    double gyro_scale = 0;        //!< scale error, standard deviation of each axis
    double accel_scale = 0;
    double gyro_misalignment = 0;  //!< axes against one another, standard deviation [rad]
    double accel_misalignment = 0;
    double gyro_range = 1e9;   //!< saturation [rad/s]
    double accel_range = 1e9;  //!< [m/s^2]
    double clock_offset = 0;   //!< of the IMU's stamps against the LiDAR's [s]
    double clock_drift = 0;    //!< by which its clock is too fast against the LiDAR's [s/s]
    /** The sensor warms up: by warming * (1 - exp(-t / warming_time)) until t. The biases follow,
     * on each axis by a coefficient of its own. */
    double warming = 0;               //!< in the end [K]; < 0 cools down, 0 = constant temperature
    double warming_time = 60;         //!< time constant [s]
    double gyro_temperature = 0;      //!< bias a kelvin, standard deviation of each axis [rad/s/K]
    double accel_temperature = 0;     //!< [m/s^2/K]
    double gyro_vibration = 0;        //!< amplitude of the vibration of the mount [rad/s]
    double accel_vibration = 0;       //!< [m/s^2]
    double vibration_frequency = 90;  //!< [Hz]
    bool averaging =
        true;  //!< a sample is the mean over its interval; else the value at its middle
};

ImuConfig imuPreset(ImuPreset preset);
void declare(ConfigSection& section, ImuConfig& config);

/** What the IMU says, and what was true. All arrays have one entry a sample. */
struct ImuRecording
{
    ImuSamples samples;           //!< stamped by the IMU's clock, since the start of the simulation
    std::vector<Duration> times;  //!< true time: the middle of the sample's interval [ns]
    std::vector<Vector3d> gyro_bias, accel_bias;
};

/** Samples over [0, duration]. Deterministic in the seed. */
ImuRecording simulateImu(
    const ImuConfig& config, const Motion& motion, double duration, std::uint64_t seed);

/** What a perfect IMU reads at one instant: angular rate and specific force, R^T (a + g). */
ImuSample trueImu(const MotionState& state);
}  // namespace taut::simulation
