#pragma once

#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Renderer.h"
#include "taut/render/PointCloud.h"

namespace taut
{
/** Size of a picture [pixels]. */
struct PixelSize
{
    int width = 0, height = 0;
};

/** From where and how a view looks at the world. */
struct ViewCamera
{
    PixelSize size;
    bool orthographic = false;
    Pose T_world_camera;  //!< x to the right, y down, z forward
    double scale = 1;     //!< pixels per metre (orthographic) or focal length in pixels
    double near_depth = 1, far_depth = 2;  //!< [m] only what lies between is shown
    double focus_depth = 1;                //!< [m] of what the view is about

    /** The point in the frame of the camera. */
    Vector3d inCamera(const Vector3d& p_world) const
    {
        return T_world_camera.R.transpose() * (p_world - T_world_camera.p);
    }

    /** Pixel (u to the right, v down, from the upper left corner of the picture) and depth [m]. */
    Vector3d project(const Vector3d& p_world) const;

    /** Size of a pixel [m] at that depth. */
    double metresPerPixel(double depth) const { return orthographic ? 1 / scale : depth / scale; }

    /** Whether the point is between the near and the far end and within the picture. */
    bool sees(const Vector3d& p_world) const;
};

/** The values of axis . p over all points and poses p, of which there is at least one. */
Span extentAlong(
    const PointCloud& points, const std::vector<Pose>& trajectory, const Vector3d& axis);

/** The camera of a view. For Top and Oblique all of the points and of the trajectory are in sight:
 * leave strays out of the points. There must be something to see, and for Follow a trajectory, as
 * requireDrawable() tells. */
ViewCamera makeCamera(
    View view, const PointCloud& points, const std::vector<Pose>& trajectory, PixelSize size);
}  // namespace taut
