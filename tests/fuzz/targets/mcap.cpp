#include "bags.h"

/* A bag of ROS 2 in MCAP. */
TAUT_FUZZ_TARGET(input)
{
    taut::fuzz::readBag("a.mcap", input);
}
