#include "OusterUdp.h"

#include <mrpt/core/initializer.h>

#include <stdexcept>

#include "taut/packets/ouster/Decoder.h"

IMPLEMENTS_GENERIC_SENSOR(OusterUdp, taut)

// When the library is loaded, rawlog-grabber knows the driver by its name.
MRPT_INITIALIZER(register_OusterUdp)
{
    taut::OusterUdp::doRegister();
}

namespace taut
{
namespace
{
constexpr auto kSilence = std::chrono::milliseconds(100);
constexpr std::size_t kMostAtOnce = 1000;  // datagrams, before the observations are handed over
constexpr std::size_t kWarnEach = 1000;    // of what repeats

std::uint16_t portOr(int given, std::uint16_t described)
{
    if (given < 0 || given > 65535)
        throw std::runtime_error(std::to_string(given) + " is no UDP port");
    return given == 0 ? described : static_cast<std::uint16_t>(given);
}
}  // namespace

void OusterUdp::loadConfig_sensorSpecific(
    const mrpt::config::CConfigFileBase& config, const std::string& section)
{
    ImportingSensor::loadConfig_sensorSpecific(config, section);
    json_ = config.read_string(section, "ouster_json", "");
    device_ip_ = config.read_string(section, "device_ip", "");
    bind_address_ = config.read_string(section, "bind_address", bind_address_);
    lidar_port_ = config.read_int(section, "lidar_port", lidar_port_);
    imu_port_ = config.read_int(section, "imu_port", imu_port_);
    computer_clock_ = config.read_bool(section, "computer_clock", computer_clock_);
    if (json_.empty()) throw std::runtime_error("[" + section + "] has no ouster_json");
}

void OusterUdp::initialize()
{
    ouster::SensorInfo info = ouster::loadSensorInfo(json_);
    info.lidar_port = portOr(lidar_port_, info.lidar_port);
    info.imu_port = portOr(imu_port_, info.imu_port);
    if (info.lidar_port == info.imu_port)
        throw std::runtime_error("lidar_port and imu_port must differ");
    decoder_ = makeOusterDecoder(info, computer_clock_ ? StampClock::Capture : StampClock::Sensor);
    receiver_ = std::make_unique<UdpReceiver>(
        bind_address_, std::vector<std::uint16_t>{info.lidar_port, info.imu_port});
    m_state = ssWorking;
}

void OusterUdp::doProcess()
{
    auto wait = kSilence;
    for (std::size_t i = 0; i < kMostAtOnce; i++)
    {
        const auto datagram = receiver_->next(wait);
        if (!datagram) break;
        take(*datagram);
        wait = std::chrono::milliseconds(0);
    }
    reportLost();
}

bool OusterUdp::isFromTheSensor(const UdpDatagram& datagram)
{
    const bool is = sensor_ ? datagram.from == *sensor_
                            : device_ip_.empty() || addressText(datagram.from) == device_ip_;
    if (!is && others_++ == 0)
        warnings()(
            {datagram.captured, "second_sensor",
             "datagrams from " + addressText(datagram.from) + " are left out"});
    return is;
}

void OusterUdp::take(const UdpDatagram& datagram)
{
    if (!isFromTheSensor(datagram)) return;
    ImportedItems items;
    try
    {
        decoder_->add(datagram, items);
        sensor_ = datagram.from;
    }
    catch (const ouster::DescriptionError& e)
    {
        throw std::runtime_error("'" + json_ + "': " + e.what());
    }
    catch (const std::runtime_error& e)
    {
        if (bad_++ % kWarnEach == 0)
            warnings()(
                {datagram.captured, "packet_invalid",
                 std::string(e.what()) + " (" + std::to_string(bad_) + " so far)"});
    }
    for (const auto& item : items) give(item);
}

void OusterUdp::reportLost()
{
    const std::size_t lost = receiver_->lost();
    if (lost < lost_ + kWarnEach && (lost_ != 0 || lost == 0)) return;
    lost_ = lost;
    warnings()(
        {0, "packets_lost",
         std::to_string(lost) +
             " datagrams so far found no room: raise net.core.rmem_max (docs/capturing.md)"});
}
}  // namespace taut
