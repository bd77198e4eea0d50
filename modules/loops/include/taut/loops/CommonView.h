#pragma once

#include <vector>

#include "taut/core/Map.h"
#include "taut/core/Submap.h"

namespace taut
{
/** What key scans say of a point. */
enum class Visibility : std::uint8_t
{
    Unknown,  //!< out of view, or hidden behind something
    Past,     //!< rays passed, but so flat along the surface that it may still be there
    Surface,  //!< where a ray ended
    Free,     //!< where rays passed
};

/** What one key scan says of a point (frame of the sensor): Free if the ray in its direction passed
 * it well before it ended. How well: by as much as the range may change within a cell of the image
 * on the surface that the point is of, whose normal is given (the same frame; zero: it is of none).
 * Points of no surface, such as leaves, which rays pass through, are never Free but Past. */
Visibility visibilityOf(const Vector3d& point, const Vector3d& normal, const KeyScan& key);

/** Looks at points with the key scans of a submap: [i] of points[i], whose position is
 * T_submap_other * points[i].position, and whose normal normals[i] is in the frame of the points. A
 * point is Free if a key scan says so and none sees a surface there. */
std::vector<Visibility> visibilityOf(
    const std::vector<MapPoint>& points, const std::vector<Vector3d>& normals,
    const Pose& T_submap_other, const Submap& submap);

/** What both submaps could see, by cells of 0.5 m: a wall of a thousand points is one thing. */
struct CommonView
{
    int points = 0;      //!< that both could see
    int on_surface = 0;  //!< of these, on a surface of the other
    int cells = 0;       //!< that hold them
    int conflicts = 0;   //!< of these, where most points lie in space that the other saw free
    int sectors =
        0;  //!< of eight around the middle of the other, that hold a tenth of a fair share
};

CommonView commonView(
    const std::vector<MapPoint>& points, const Pose& T_submap_other,
    const std::vector<Visibility>& visibility, const std::vector<bool>& on_surface);
}  // namespace taut
