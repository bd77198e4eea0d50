#include "../../../modules/importing/src/bag/Messages.h"

#include "../../../modules/importing/src/bag/SweepClock.h"
#include "support.h"

namespace
{
using namespace taut;
using namespace taut::bag;

/** Messages of ROS: pieces, each with a byte for its type and wire. */
class Messages
{
 public:
    void read(fuzz::Input piece)
    {
        const std::uint8_t kind = piece.byte();
        const std::vector<std::uint8_t> bytes = piece.bytes();
        const WireReader reader(
            {bytes.data(), bytes.size()}, (kind & 1) == 0 ? Wire::Cdr : Wire::Ros1);
        switch (kind >> 1)
        {
            case 0:
                sweeps_.push_back(toRawSweep(readPointCloud2(reader)));
                break;
            case 1:
                sweeps_.push_back(toRawSweep(readLivox(reader)));
                break;
            case 2:
                readImu(reader);
                break;
            default:
                readPacketsOf(kPacketTypes[(kind >> 1) % 5], reader);
        }
    }

    void toScans(ScanStamp stamp)
    {
        std::vector<const RawSweep*> all;
        for (const RawSweep& sweep : sweeps_) all.push_back(&sweep);
        SweepClock clock(stamp, [](const Warning&) {});
        clock.learn(all);
        for (RawSweep& sweep : sweeps_) fuzz::readOrRefuse([&] { clock.toScan(std::move(sweep)); });
    }

 private:
    static constexpr const char* kPacketTypes[] = {
        "velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets",
        "ouster_ros/PacketMsg", "ouster_sensor_msgs/PacketMsg"};

    static void readPacketsOf(const std::string& type, const WireReader& reader)
    {
        fuzz::require(isPacketType(type), "these are types of packets");
        unsigned sum = 0;
        for (const RawPacket& packet : readPackets(type, reader))
            for (std::size_t i = 0; i < packet.data.size; i++) sum += packet.data.data[i];
        static volatile unsigned keep;
        keep = sum;
    }

    std::vector<RawSweep> sweeps_;
};
}  // namespace

TAUT_FUZZ_TARGET(input)
{
    const auto stamp = static_cast<ScanStamp>(input.byte() % 3);
    Messages messages;
    while (!input.empty())
    {
        const fuzz::Input piece = input.piece();
        fuzz::readOrRefuse([&] { messages.read(piece); });
    }
    fuzz::readOrRefuse([&] { messages.toScans(stamp); });
}
