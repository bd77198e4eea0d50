#include "VelodyneSweeps.h"

#include <cmath>
#include <utility>

namespace taut
{
namespace
{
constexpr int kWrap = 3000;                      // [0.01 deg] more than packets out of order show
constexpr Duration kLongestSweep = 250'000'000;  // 5 Hz is the slowest turn
constexpr Duration kLatest = 50'000'000;         // a packet that is no sign of another clock
constexpr std::size_t kMostPackets = 2000;       // whatever the clock says

void checkDecodes(const velodyne::Packet& packet, velodyne::Model model)
{
    std::vector<velodyne::Return> returns;
    velodyne::decodePacket(packet.data(), velodyne::defaultCalibration(model), returns);
}
}  // namespace

std::optional<VelodyneSweep> VelodyneSweeps::add(const velodyne::Packet& packet, Time captured)
{
    const auto info = velodyne::packetInfo(packet.data());
    checkDecodes(packet, info.model);
    const Duration duration = velodyne::packetDuration(info);
    const Duration t = clock_.sinceFirst(info.microseconds);
    const int azimuth = velodyne::blockAzimuth(packet.data(), 0);
    auto& packets = sweep_.scan.packets;
    std::optional<VelodyneSweep> complete;
    const bool late = last_azimuth_ >= 0 && t < last_ && last_ - t < kLatest;
    if (late && !packets.empty())  // captured in another order than sent
    {
        packets.push_back(packet);
        missing_ -= missing_ > 0 ? 1 : 0;
        return complete;
    }
    if (!packets.empty() &&
        (azimuth < last_azimuth_ - kWrap || t - sweep_.scan.stamp > kLongestSweep ||
         packets.size() == kMostPackets))
        complete = finish();
    if (last_azimuth_ >= 0 && t - last_ > duration * 3 / 2)
        missing_ += static_cast<std::size_t>((t - last_ + duration / 2) / duration - 1);
    if (packets.empty())
    {
        sweep_.scan.stamp = t;
        sweep_.captured = captured - duration;
    }
    packets.push_back(packet);
    last_ = t;
    last_azimuth_ = azimuth;
    return complete;
}

std::optional<VelodyneSweep> VelodyneSweeps::finish()
{
    if (sweep_.scan.packets.empty()) return {};
    return std::exchange(sweep_, {});
}
}  // namespace taut
