#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut::simulation
{
/** Triangles with the share of light that each reflects. */
struct Mesh
{
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Vector3d> vertices;  //!< [m]
    std::vector<Triangle> triangles;
    std::vector<float> reflectivity;  //!< of each triangle, 0..1

    /** Adds another mesh, moved by T. */
    void append(const Mesh& other, const Pose& T = {});
};

/** A flat four-sided patch with the corners in order around it. */
void addQuad(
    Mesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
    float reflectivity);

/** A box of full size `size` centred at T.p, turned by T.R. */
void addBox(Mesh& mesh, const Pose& T, const Vector3d& size, float reflectivity);

/** A box standing on `base` (centre of its bottom), turned by yaw [rad]. */
void addStandingBox(
    Mesh& mesh, const Vector3d& base, const Vector3d& size, double yaw, float reflectivity);

/** A cylinder or cone frustum between the centres of its two ends, closed at both. */
void addFrustum(
    Mesh& mesh, const Vector3d& bottom, const Vector3d& top, double radius_bottom,
    double radius_top, int sides, float reflectivity);

/** Ground z = height(x, y) over a rectangle, in square cells of about `cell` [m]. */
void addGround(
    Mesh& mesh, double min_x, double min_y, double max_x, double max_y, double cell,
    const std::function<double(double, double)>& height, float reflectivity);

/** A box, as seen from inside: the same surfaces, by its opposite corners. */
void addRoom(Mesh& mesh, const Vector3d& min, const Vector3d& max, float reflectivity);
}  // namespace taut::simulation
