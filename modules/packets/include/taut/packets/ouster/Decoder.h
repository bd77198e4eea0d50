#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/packets/ouster/SensorInfo.h"

/** \file Decoder.h
 * Ouster packets (UDP payloads) to scans and IMU samples. Pure functions over bytes: neither files
 * nor sockets nor clocks; all times are the sensor's. Source: Ouster firmware user manual, "Lidar
 * Data", "IMU Data" and "Lidar Range to XYZ". */
namespace taut::ouster
{
inline constexpr std::size_t kImuPacketBytes = 48;

/** Standard gravity, in which the sensor gives specific forces [m/s^2]. */
inline constexpr double kStandardGravity = 9.80665;

/** The packets cannot be of the sensor that the description describes; nothing of them can be
 * believed. */
struct DescriptionError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** Size of a lidar packet of that sensor. */
std::size_t lidarPacketBytes(const SensorInfo& info);

/** Why these bytes are no lidar packet of that sensor, by its size and serial number; empty if they
 * may be one. */
std::string misfit(const SensorInfo& info, const std::uint8_t* packet, std::size_t bytes);

/** An IMU packet of kImuPacketBytes in SI units; its time is that of the gyroscope's reading.
 * Throws std::runtime_error if that is none. */
ImuSample decodeImu(const std::uint8_t* packet);

/** One turn of the sensor. */
struct Frame
{
    int id = 0;
    int columns = 0;  //!< that are valid, of SensorInfo::columns_per_frame
    /** Points in the lidar frame, in the order of the columns; intensity is the reflectivity, ring
     * the pixel of the column (0 is the highest beam). T_imu_lidar is the sensor's own. */
    Scan scan;
};

/** Puts the columns of lidar packets together to frames. */
class FrameAssembler
{
 public:
    explicit FrameAssembler(const SensorInfo& info);

    /** A packet in the order of arrival. Gives the frame that it shows to be complete. Throws
     * DescriptionError on another size, serial number, number of columns or rate than described,
     * and std::runtime_error on times that contradict each other. */
    std::optional<Frame> add(const std::uint8_t* packet, std::size_t bytes);

    /** What is left at the end. */
    std::optional<Frame> finish();

    /** Time of the last valid column of the packet added last; nothing if it had none. */
    std::optional<Time> packetTime() const { return packet_time_; }

    /** Columns that came after the first of a later frame, and were left out. */
    std::size_t lateColumns() const { return late_; }

 private:
    void addColumn(const std::uint8_t* column);
    void checkPace(int measurement, Time t);
    void addPoints(const std::uint8_t* column, int measurement, Time t);

    SensorInfo info_;
    struct Beam
    {
        double azimuth, cos_altitude, sin_altitude;
    };
    std::vector<Beam> beams_;
    Frame frame_;
    bool started_ = false;
    std::optional<Time> packet_time_;
    int last_measurement_ = -1;
    Time last_time_ = 0;
    int wrong_paces_ = 0;
    std::size_t late_ = 0;
};
}  // namespace taut::ouster
