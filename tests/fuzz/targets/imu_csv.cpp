#include "imported.h"

/* The IMU's table in a folder of clouds. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    static const std::string cloud =
        folder.write("1700000000.25.csv", std::string("x,y,z,t\n1,2,3,1700000000.25\n"));
    folder.write("imu.csv", input);
    fuzz::readOrRefuse([] { fuzz::importAll(folder.path()); });
}
