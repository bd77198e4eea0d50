#include "VelodynePackets.h"

#include <algorithm>
#include <cmath>

namespace taut
{
std::vector<velodyne::Packet> packetsOf(
    const Scan& scan, velodyne::Model model, double azimuth, double rotation_rate)
{
    const velodyne::FiringPattern& pattern = velodyne::firingPattern(model);
    const auto sequenceOf = [&pattern](const LidarPoint& p)
    {
        const double begin = p.offset - pattern.laser_period * p.ring;
        return static_cast<std::size_t>(std::max(0L, std::lround(begin / pattern.sequence_period)));
    };
    std::size_t count = 0;
    for (const LidarPoint& p : scan.points) count = std::max(count, sequenceOf(p) + 1);

    std::vector<std::vector<velodyne::Cell>> sequences(
        count, std::vector<velodyne::Cell>(static_cast<std::size_t>(pattern.lasers)));
    for (const LidarPoint& p : scan.points)
    {
        if (!p.position.allFinite()) continue;
        sequences[sequenceOf(p)][p.ring] = {
            p.position.cast<double>().norm(), static_cast<std::uint8_t>(p.intensity)};
    }

    velodyne::PacketWriter writer(model);
    for (std::size_t i = 0; i < count; i++)
    {
        const Duration since = std::llround(pattern.sequence_period * static_cast<double>(i));
        writer.add(
            scan.stamp + since, std::fmod(azimuth + 360 * rotation_rate * toSeconds(since), 360),
            sequences[i]);
    }
    return writer.take(true);
}

Scan decoded(const PacketScan& packets)
{
    Scan scan;
    scan.stamp = scan.end = packets.stamp;
    scan.T_imu_lidar = packets.T_imu_lidar;
    velodyne::PacketClock clock;
    for (const velodyne::Packet& packet : packets.packets)
    {
        const auto info = velodyne::packetInfo(packet.data());
        const auto& calibration = velodyne::defaultCalibration(info.model);
        scan.rings = static_cast<int>(calibration.size());
        std::vector<velodyne::Return> returns;
        velodyne::decodePacket(packet.data(), calibration, returns);
        const Duration since = clock.sinceFirst(info.microseconds);
        for (const velodyne::Return& r : returns)
        {
            const auto offset = static_cast<std::int32_t>(since + r.offset);
            scan.points.push_back({r.position, static_cast<float>(r.intensity), offset, r.laser});
            scan.end = std::max(scan.end, scan.timeOf(scan.points.back()));
        }
    }
    return scan;
}
}  // namespace taut
