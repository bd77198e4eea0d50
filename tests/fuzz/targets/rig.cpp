#include "taut/rawlog/Rig.h"
#include "support.h"

/* A rig file. */
TAUT_FUZZ_TARGET(input)
{
    taut::fuzz::readOrRefuse([&] { taut::parseRig(input.text(), "rig.yaml"); });
}
