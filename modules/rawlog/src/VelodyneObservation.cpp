#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstring>
#include <stdexcept>

#include "MrptConversion.h"
#include "ObservationToScan.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut
{
using mrpt::obs::CObservationVelodyneScan;

namespace
{
// A cloud that somebody filled point by point; times and lasers may be missing.
ScanBuilder fromPointCloud(const CObservationVelodyneScan& scan)
{
    const auto& cloud = scan.point_cloud;
    const std::size_t n = cloud.x.size();
    const auto fits = [n](const auto& values, bool required)
    { return values.size() == n || (!required && values.empty()); };
    if (!fits(cloud.y, true) || !fits(cloud.z, true) || !fits(cloud.intensity, false) ||
        !fits(cloud.timestamp, false) || !fits(cloud.laser_id, false))
        throw std::runtime_error("the vectors of its point cloud differ in length");

    const Time stamp = toTime(scan.timestamp);
    ScanBuilder builder(stamp, n);
    for (std::size_t i = 0; i < n; i++)
        builder.add(
            {cloud.x[i], cloud.y[i], cloud.z[i]},
            cloud.intensity.empty() ? 0.0f : static_cast<float>(cloud.intensity[i]),
            cloud.timestamp.empty() ? stamp : toTime(cloud.timestamp[i]),
            cloud.laser_id.empty() ? 0 : cloud.laser_id[i]);
    return builder;
}

constexpr double kDegree = M_PI / 180;

velodyne::Calibration calibrationOf(const CObservationVelodyneScan& scan, velodyne::Model model)
{
    if (scan.calibration.empty()) return velodyne::defaultCalibration(model);
    velodyne::Calibration calibration;
    for (const auto& c : scan.calibration.laser_corrections)
        calibration.push_back(
            {c.verticalCorrection * kDegree, c.azimuthCorrection * kDegree, c.distanceCorrection,
             c.verticalOffsetCorrection, c.horizontalOffsetCorrection});
    return calibration;
}

/* The observation's stamp is the time of the first firing of its first packet (MRPT's definition),
 * by whichever clock the recorder used; the packets' own clock tells the rest relative to it. */
ScanBuilder fromPackets(const CObservationVelodyneScan& scan)
{
    using Packet = CObservationVelodyneScan::TVelodyneRawPacket;
    static_assert(sizeof(Packet) == velodyne::kPacketBytes);
    const Time stamp = toTime(scan.timestamp);
    ScanBuilder builder(stamp, scan.scan_packets.size() * velodyne::kBlocks * 32);
    velodyne::PacketClock clock;
    velodyne::Calibration calibration;
    std::vector<velodyne::Return> returns;
    std::uint8_t bytes[velodyne::kPacketBytes];
    for (const Packet& packet : scan.scan_packets)
    {
        std::memcpy(bytes, &packet, sizeof bytes);
        if (calibration.empty())
            calibration = calibrationOf(scan, velodyne::packetInfo(bytes).model);
        returns.clear();
        const auto info = velodyne::decodePacket(bytes, calibration, returns);
        const Time packet_time = stamp + clock.sinceFirst(info.microseconds);
        for (const auto& r : returns)
            builder.add(r.position, r.intensity, packet_time + r.offset, r.laser);
    }
    builder.setRings(static_cast<int>(calibration.size()));
    return builder;
}
}  // namespace

ScanBuilder velodyneToPoints(const CObservationVelodyneScan& scan)
{
    return scan.scan_packets.empty() ? fromPointCloud(scan) : fromPackets(scan);
}
}  // namespace taut
