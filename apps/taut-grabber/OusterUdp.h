#pragma once

#include <memory>
#include <optional>

#include "ImportingSensor.h"
#include "UdpReceiver.h"
#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/ouster/SensorInfo.h"

namespace taut
{
/** An Ouster that sends its LiDAR and IMU packets to this computer: scans of a whole turn, and IMU
 * samples in m/s^2 and rad/s. Keys of its section:
 *   ouster_json     what the sensor says of itself, as it serves it (required)
 *   device_ip       address of the sensor; empty: the first that sends what fits the JSON
 *   bind_address    address of this computer to listen at; 0.0.0.0: all
 *   lidar_port, imu_port   where the sensor sends to; 0: as the JSON says
 *   computer_clock  stamps by this computer instead of the sensor */
class OusterUdp : public ImportingSensor
{
    DEFINE_GENERIC_SENSOR(OusterUdp)
 public:
    OusterUdp() : ImportingSensor("OusterUdp") {}

    /** Throws std::runtime_error if the JSON is no Ouster's or a port cannot be had. */
    void initialize() override;

    /** Throws std::runtime_error if what comes cannot be of the sensor that the JSON describes. */
    void doProcess() override;

 private:
    void loadConfig_sensorSpecific(
        const mrpt::config::CConfigFileBase& config, const std::string& section) override;
    void take(const UdpDatagram& datagram);
    bool isFromTheSensor(const UdpDatagram& datagram);
    void reportLost();

    std::string json_, device_ip_, bind_address_ = "0.0.0.0";
    int lidar_port_ = 0, imu_port_ = 0;
    bool computer_clock_ = false;

    std::unique_ptr<UdpReceiver> receiver_;
    std::unique_ptr<PacketDecoder> decoder_;
    std::optional<std::uint32_t> sensor_;  // its address
    std::size_t bad_ = 0, others_ = 0, lost_ = 0;
};
}  // namespace taut
