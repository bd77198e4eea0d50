#pragma once

#include <mrpt/rtti/CObject.h>

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Geometry.h"

namespace taut
{
/** What a picture shows. Either points or a trajectory may be missing, not both. */
struct RenderScene
{
    /** The map, world frame [m]; coloured by height. Points that are not finite are left out. */
    std::vector<Eigen::Vector3f> points;
    std::vector<Pose> trajectory;      //!< T_world_imu in the order of time
    std::vector<std::string> caption;  //!< lines of text: sequence, length, duration, mode
    /** Places of the body that a loop joined, world frame [m]. */
    std::vector<std::pair<Vector3d, Vector3d>> loops = {};
};

enum class View
{
    Top,  //!< straight down, orthographic; x to the right, or up where the map is taller than wide
    Oblique,  //!< from a corner, the whole map in sight
    Follow,   //!< behind and above the body at the end of the trajectory
};
inline constexpr std::array<View, 3> kAllViews{View::Top, View::Oblique, View::Follow};

/** Name of a view in options and in names of files: "top". */
constexpr const char* nameOf(View view)
{
    return view == View::Top ? "top" : view == View::Oblique ? "oblique" : "follow";
}

/** What every renderer asks of a scene. Throws std::runtime_error if there is neither a finite
 * point nor a trajectory, if a pose is not finite, or if there is no trajectory to follow. */
void requireDrawable(const RenderScene& scene, View view);

/** Plug point: makes an image file of a scene. */
class Renderer : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Renderer)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** Writes a PNG. Throws std::runtime_error with the cause if it cannot: requireDrawable(), or a
     * file that cannot be written. */
    virtual void render(const RenderScene& scene, View view, const std::string& png_path) = 0;
};
}  // namespace taut
