#include "taut/core/Renderer.h"

#include <algorithm>
#include <stdexcept>

namespace taut
{
void requireDrawable(const RenderScene& scene, View view)
{
    const bool any_point = std::any_of(
        scene.points.begin(), scene.points.end(),
        [](const Eigen::Vector3f& p) { return p.allFinite(); });
    if (!any_point && scene.trajectory.empty())
        throw std::runtime_error("nothing to draw: neither points nor a trajectory");
    for (std::size_t i = 0; i < scene.trajectory.size(); ++i)
        if (!scene.trajectory[i].p.allFinite() || !scene.trajectory[i].R.allFinite())
            throw std::runtime_error(
                "pose " + std::to_string(i) + " of the trajectory to draw is not finite");
    if (view == View::Follow && scene.trajectory.empty())
        throw std::runtime_error("no trajectory for the view to follow");
}
}  // namespace taut
