#pragma once

#include <memory>
#include <string>
#include <vector>

#include "../ImportFormat.h"
#include "BagReader.h"

namespace taut::bag
{
/** True for the packets of the IMU in an Ouster, by the name of their topic: their type is that of
 * its lidar packets. */
bool isOusterImu(const BagTopic& topic);

/** Reads the packets of one LiDAR from a bag: VelodyneScan, PandarScan, NebulaPackets, PacketMsg;
 * readings from sensor_msgs/Imu or the Ouster's own packets. Scans begin where the head of the
 * sensor passes zero, however the driver put packets together to messages.
 *
 * Warnings, besides those of the bag's container:
 *   message_invalid  a message that is not what its type says was left out
 *   packet_invalid   a packet that cannot be decoded was left out
 *   packets_late     columns that came after their turn was over were left out
 *   no_stamp         a reading whose stamp is zero was left out
 *   no_imu           no reading in the whole bag
 *   clock_offset     the stamps of the LiDAR and of the IMU are of clocks that differ
 *
 * Throws std::runtime_error, naming file and cause, if an Ouster's description is not there or not
 * that of the sensor, or the topic of the IMU is ambiguous; next() does if no packet could be
 * decoded. */
std::unique_ptr<ImportSource> openPackets(
    const std::string& path, std::unique_ptr<BagReader> reader, const std::vector<BagTopic>& topics,
    const BagTopic& lidar, const ImportOptions& options, const WarningSink& warn);
}  // namespace taut::bag
