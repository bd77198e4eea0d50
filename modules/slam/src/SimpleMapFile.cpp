#include "taut/slam/SimpleMapFile.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <algorithm>

#include "taut/core/writeError.h"

namespace taut
{
namespace
{
// Of a submap, and of all: MRPT holds the whole map in memory.
constexpr std::size_t kMostPoints = 5000;
constexpr std::size_t kMostOfAll = 20'000'000;

mrpt::poses::CPose3D toMrpt(const Pose& pose)
{
    mrpt::math::CMatrixDouble33 R;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) R(r, c) = pose.R(r, c);
    return {R, mrpt::math::TPoint3D(pose.p.x(), pose.p.y(), pose.p.z())};
}

mrpt::obs::CSensoryFrame viewOf(const Submap& submap, std::size_t most)
{
    auto cloud = mrpt::maps::CSimplePointsMap::Create();
    const std::size_t n = submap.points.size(), count = std::min(n, most);
    for (std::size_t i = 0; i < count; i++)
    {
        const Eigen::Vector3f& p = submap.points[i * n / count].position;
        cloud->insertPoint(p.x(), p.y(), p.z());
    }
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->pointcloud = cloud;
    observation->sensorLabel = "taut";
    observation->timestamp =
        mrpt::Clock::fromDouble(static_cast<double>(submap.scans.front().t) * 1e-9);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    return frame;
}
}  // namespace

void writeSimpleMap(const std::string& path, const Mapper& mapper)
{
    mrpt::maps::CSimpleMap map;
    const std::size_t submaps = std::max<std::size_t>(1, mapper.resultGraph().vertices.size());
    const std::size_t most = std::min(kMostPoints, kMostOfAll / submaps);
    const PoseGraph graph = mapper.resultGraph();
    for (const GraphVertex& vertex : graph.vertices)
    {
        mrpt::poses::CPose3DPDFGaussian pose;
        pose.mean = toMrpt(vertex.T_world_submap);
        map.insert(pose, viewOf(*mapper.submap(vertex.id), most));
    }
    errno = 0;
    if (!map.saveToFile(path)) throw writeError(path);
}
}  // namespace taut
