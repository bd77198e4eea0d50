#include "packets.h"
#include "taut/packets/velodyne/FrameAssembler.h"

/* Data packets of all models of Velodyne, decoded both ways: kept as packets, and as points. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    const std::uint8_t choice = input.byte();
    const auto decoder = makeVelodyneDecoder(static_cast<StampClock>(choice % 3), choice >= 128);
    fuzz::decodePackets(input, *decoder, 2368);

    for (const auto model :
         {velodyne::Model::Hdl32, velodyne::Model::Vlp16, velodyne::Model::Vlp32,
          velodyne::Model::Vls128})
    {
        velodyne::FrameAssembler frames(model, velodyne::defaultCalibration(model));
        std::vector<Scan> complete;
        for (fuzz::Input rest = input; !rest.empty();)
        {
            const std::vector<std::uint8_t> packet = rest.piece().bytes();
            if (packet.size() == velodyne::kPacketBytes)
                fuzz::readOrRefuse([&] { frames.add(packet.data(), complete); });
        }
        frames.finish(complete);
    }
}
