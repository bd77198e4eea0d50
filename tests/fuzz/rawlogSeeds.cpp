#include "../rawlog/mrpt_support.h"
#include "../support/velodyne_bytes.h"
#include "seeds.h"

namespace taut::fuzz
{
using namespace taut::test;

namespace
{
mrpt::obs::CObservationVelodyneScan packetScan(Time t)
{
    const auto bytes = knownPacket();
    auto scan = mrptScan(t);
    scan.point_cloud = {};
    scan.scan_packets.resize(1);
    static_assert(sizeof(scan.scan_packets[0]) == sizeof(bytes), "a packet as it was sent");
    std::memcpy(static_cast<void*>(scan.scan_packets.data()), bytes.data(), bytes.size());
    return scan;
}
}  // namespace

void addRawlogSeeds(const Seeds& seeds)
{
    LogBytes clouds, packets, images, frames;
    for (int k = 0; k < 3; k++)
    {
        const Time t = kStart + k * 100 * kMillisecond;
        const auto imu = mrptImu(t);
        clouds.add(imu).add(mrptScan(t));
        packets.add(imu).add(packetScan(t));
        images.add(imu).add(rotatingScan(t));
        mrpt::obs::CSensoryFrame frame;
        frame.insert(mrpt::obs::CObservationIMU::Create(imu));
        frame.insert(mrpt::obs::CObservationVelodyneScan::Create(fullVelodyneScan(t)));
        frames.add(mrpt::obs::CActionCollection()).add(frame);
    }
    seeds.add("rawlog", "clouds", clouds.bytes());
    seeds.add("rawlog", "packets", packets.bytes());
    seeds.add("rawlog", "images", images.bytes());
    seeds.add("rawlog", "frames", frames.bytes());
    RawlogWriter writer(seeds.file("rawlog", "compressed"));
    writeLog(writer, 1);
    writer.close();
}
}  // namespace taut::fuzz
