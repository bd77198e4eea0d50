#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"

/** \file SensorInfo.h
 * What an Ouster says about itself: the JSON that it serves and that its programs store beside a
 * capture. Source: Ouster firmware user manual, "Sensor Data" and "Coordinate Frames". */
namespace taut::ouster
{
/** How a lidar packet is laid out (udp_profile_lidar). */
enum class Profile : std::uint8_t
{
    Legacy,
    Rng19Rfl8Sig16Nir16,
    Rng19Rfl8Sig16Nir16Dual,
    Rng15Rfl8Nir8,
    Rng15Rfl8Nir8Dual,
    FusaRng15Rfl8Nir8Dual,
};

struct SensorInfo
{
    std::string model;         //!< "OS-1-128"; empty where it is not told
    std::uint64_t serial = 0;  //!< 0 where it is not told
    Profile profile = Profile::Legacy;
    bool legacy_imu = true;  //!< IMU packets of 48 bytes
    int columns_per_frame = 0, columns_per_packet = 16, pixels_per_column = 0;
    double frame_rate = 0;                              //!< [Hz]; 0 where it is not told
    std::vector<double> beam_altitudes, beam_azimuths;  //!< [rad], one a pixel of a column
    /** Where a beam starts, seen from the axis of rotation at encoder angle 0 [m]. */
    Vector3d beam_origin = Vector3d::Zero();
    Pose T_sensor_lidar, T_sensor_imu;
    std::uint16_t lidar_port = 7502, imu_port = 7503;

    Pose T_imu_lidar() const { return T_sensor_imu.inverse() * T_sensor_lidar; }
};

/** From the JSON's text: the flat one of old firmware and the nested one of new. Throws
 * std::runtime_error naming the key that is missing or wrong. */
SensorInfo parseSensorInfo(const std::string& json);

/** The same from a file, which is named in the message. */
SensorInfo loadSensorInfo(const std::string& path);
}  // namespace taut::ouster
