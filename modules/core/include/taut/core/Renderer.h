#pragma once

#include <mrpt/rtti/CObject.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Geometry.h"

namespace taut
{
/** What a picture shows. */
struct RenderScene
{
    std::vector<Eigen::Vector3f> points;  //!< the map, world frame [m]; coloured by height
    std::vector<Pose> trajectory;         //!< T_world_imu in the order of time
    std::vector<std::string> caption;     //!< lines of text: sequence, length, duration, mode
};

enum class View
{
    Top,      //!< straight down, north-up, orthographic
    Oblique,  //!< from a corner, the whole map in sight
    Follow,   //!< behind and above the body at the end of the trajectory
};

/** Plug point: makes an image file of a scene. */
class Renderer : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Renderer)
   public:
    virtual void configure(ConfigSection& section) = 0;

    /** Writes a PNG. Throws std::runtime_error with the cause if it cannot. */
    virtual void render(const RenderScene& scene, View view, const std::string& png_path) = 0;
};
}  // namespace taut
