#include "bags.h"

/* A bag of ROS 1. */
TAUT_FUZZ_TARGET(input)
{
    taut::fuzz::readBag("a.bag", input);
}
