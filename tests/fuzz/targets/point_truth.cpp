#include "support.h"
#include "taut/trajectory/PointTruth.h"

/* undistorted.points, and its scores against itself. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const std::string path = folder.write("undistorted.points", input);
    fuzz::readOrRefuse(
        [&]
        {
            PointTruthReader reader(path);
            for (UndistortedScan scan; reader.next(scan);)
            {
            }
            scorePoints(path, path);
        });
}
