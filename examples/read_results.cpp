// Read what taut-slam left in a folder: the trajectory and the map.
//   example_read_results FOLDER
#include <algorithm>
#include <iostream>
#include <string>

#include "taut/files/PlyFile.h"
#include "taut/trajectory/TrajectoryFile.h"

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: example_read_results FOLDER\n";
        return 2;
    }
    try
    {
        const std::string folder = argv[1];
        const taut::Trajectory trajectory = taut::readTum(folder + "/trajectory.tum");
        double length = 0;
        for (std::size_t i = 1; i < trajectory.size(); i++)
            length += (trajectory[i].T_world_imu.p - trajectory[i - 1].T_world_imu.p).norm();
        std::cout << trajectory.size() << " poses over " << length << " m\n";
        const std::vector<taut::PlyPoint> points = taut::readPlyPoints(folder + "/map.ply");
        float highest = points.empty() ? 0 : points.front().position.z();
        for (const taut::PlyPoint& p : points) highest = std::max(highest, p.position.z());
        std::cout << points.size() << " points, the highest at " << highest << " m\n";
    }
    catch (const std::exception& e)
    {
        std::cerr << e.what() << '\n';
        return 1;
    }
}
