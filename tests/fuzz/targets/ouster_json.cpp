#include "support.h"
#include "taut/packets/ouster/Decoder.h"

/* The description of an Ouster, and a packet of the size that it describes. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    fuzz::readOrRefuse(
        [&]
        {
            const ouster::SensorInfo info = ouster::parseSensorInfo(input.text());
            ouster::FrameAssembler frames(info);
            const std::vector<std::uint8_t> packet(ouster::lidarPacketBytes(info), 0xff);
            frames.add(packet.data(), packet.size());
            frames.finish();
        });
}
