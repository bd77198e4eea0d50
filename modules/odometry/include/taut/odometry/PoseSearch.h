#pragma once

#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Map.h"
#include "taut/core/NavState.h"

namespace taut
{
/** Where a body may be after a time in which nothing was measured: poses from which a scan is worth
 * being registered, as a glance at the map tells. For the seldom case that a prediction is metres
 * or radians off, where an iteration from it would end in a false optimum. */
class PoseSearch
{
 public:
    /** Points of a scan in the body frame (`view` towards the body), of which some hundred are
     * looked at. All references are kept. */
    PoseSearch(const std::vector<MapPoint>& scan, const Map& map, Executor& executor);

    /** Where a vehicle or a person can be `gap` seconds after a state: near where its velocity has
     * taken it, turned about the vertical; tilted as before, and as a specific force [m/s^2] in the
     * body frame says that is measured there. */
    static std::vector<Pose> posesAfter(
        double gap, const NavState& before, const Vector3d& specific_force);

    /** The best so many of the poses, best first; two of them are not nearly the same. */
    std::vector<Pose> bestOf(const std::vector<Pose>& poses, std::size_t count);

    /** How many of the points lie near a surface of the map, each counted by how near. */
    double inlierWeight(const Pose& T_world_imu);

 private:
    std::vector<MapPoint> scan_;
    const Map& map_;
    MapScratch scratch_;
    Executor& executor_;
};
}  // namespace taut
