#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/packets/velodyne/PacketWriter.h"

namespace taut
{
struct RawlogWriterConfig
{
    std::string lidar_label = "LIDAR";  //!< for scans without a label of their own
    std::string imu_label = "IMU";
    Pose T_vehicle_imu;  //!< sensorPose of the IMU
};

/** A sweep as a Velodyne sends it. */
struct PacketScan
{
    Time stamp = 0;  //!< of the first firing of the first packet
    std::vector<velodyne::Packet> packets;
    Pose T_imu_lidar;
    std::string sensor_label;  //!< empty: RawlogWriterConfig::lidar_label
};

/** Writes an observation-only rawlog that MRPT's programs and RawlogSource read: CObservationIMU,
 * and CObservationVelodyneScan with the cloud filled point by point, or with raw packets.
 * Compressed at level 1.
 *
 * What a rawlog can hold of a scan: times to 100 ns, intensities as whole numbers of 0 to 255
 * (clamped), coordinates exactly; Scan::end becomes the time of the last point.
 *
 * The file appears under its name only at close(): whatever stops the writing before leaves nothing
 * that looks like a complete log. */
class RawlogWriter
{
 public:
    /** Throws std::runtime_error naming the file if it cannot be written. */
    explicit RawlogWriter(const std::string& path, const RawlogWriterConfig& config = {});
    /** Without close(), what was written is removed. */
    ~RawlogWriter();
    RawlogWriter(const RawlogWriter&) = delete;
    RawlogWriter& operator=(const RawlogWriter&) = delete;

    /** All throw std::runtime_error if the disk does not take it. */
    void write(const ImuSample& sample);
    void write(const Scan& scan);
    void write(const PacketScan& scan);

    /** Completes the file and gives it its name, replacing an older one. Throws std::runtime_error.
     */
    void close();

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
