#include "taut/factors/Sweep.h"

#include <algorithm>

#include "taut/factors/SampledPath.h"

namespace taut
{
std::vector<Vector3d> Sweep::undistorted(const NavState& from, const NavState& to) const
{
    std::vector<Vector3d> world;
    if (scan.points.empty()) return world;
    SweepPath path(mode, motion, prior_begin, prior_end);
    path.setStates(from, to);
    const auto [first, last] = std::minmax_element(
        scan.points.begin(), scan.points.end(),
        [](const LidarPoint& a, const LidarPoint& b) { return a.offset < b.offset; });
    const SampledPath poses(path, scan.timeOf(*first), scan.timeOf(*last));
    world.reserve(scan.points.size());
    for (const LidarPoint& p : scan.points)
        world.push_back(poses.poseAt(scan.timeOf(p)) * Vector3d(p.position.cast<double>()));
    return world;
}
}  // namespace taut
