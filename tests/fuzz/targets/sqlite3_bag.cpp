#include "bags.h"

/* A bag of ROS 2 in sqlite3. */
TAUT_FUZZ_TARGET(input)
{
    taut::fuzz::readBag("a.db3", input);
}
