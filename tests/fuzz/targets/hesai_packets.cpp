#include "packets.h"

/* Data packets of all models of Hesai. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    const auto decoder = makeHesaiDecoder("", "", static_cast<StampClock>(input.byte() % 3));
    fuzz::decodePackets(input, *decoder, 2368);
}
