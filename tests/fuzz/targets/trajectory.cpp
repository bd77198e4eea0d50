#include "support.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace
{
using namespace taut;

void check(const Trajectory& trajectory)
{
    for (std::size_t i = 0; i < trajectory.size(); i++)
    {
        const Pose& pose = trajectory[i].T_world_imu;
        fuzz::require(pose.p.allFinite() && pose.R.allFinite(), "poses are finite");
        fuzz::require(i == 0 || trajectory[i].t > trajectory[i - 1].t, "time goes on");
        tumLine(trajectory[i]);
    }
}
}  // namespace

/* Trajectories of TUM, EuRoC and KITTI: the first byte is T, E or K. */
TAUT_FUZZ_TARGET(input)
{
    static const fuzz::Folder folder;
    const std::uint8_t kind = input.byte();
    const auto ignore = [](const Warning&) {};
    if (kind == 'K')
    {
        const std::string times = folder.write("times.txt", input.piece());
        const std::string poses = folder.write("poses.txt", input);
        fuzz::readOrRefuse([&] { check(readKitti(poses, times)); });
        fuzz::readOrRefuse([&] { readKitti(poses); });
        return;
    }
    const std::string path = folder.write("trajectory", input);
    fuzz::readOrRefuse([&]
                       { check(kind == 'E' ? readEuroc(path, ignore) : readTum(path, ignore)); });
}
