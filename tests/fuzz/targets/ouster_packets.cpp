#include "../importing/OusterSimulator.h"
#include "packets.h"
#include "taut/packets/ouster/Decoder.h"

/* Packets of an Ouster, in each layout. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const std::vector<ouster::SensorInfo> sensors = []
    {
        std::vector<ouster::SensorInfo> all;
        for (const char* profile :
             {"LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8",
              "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"})
        {
            test::OusterSimulator sensor;
            sensor.profile = profile;
            all.push_back(ouster::parseSensorInfo(sensor.description().dump()));
        }
        return all;
    }();
    const std::uint8_t choice = input.byte();
    const auto decoder = makeOusterDecoder(
        sensors[choice % sensors.size()], static_cast<StampClock>(choice / 6 % 3));
    fuzz::decodePackets(input, *decoder, 7502);
}
