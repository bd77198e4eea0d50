#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut::simulation
{
/** What a surface is of, where it matters. */
enum class Material : std::uint8_t
{
    Solid,
    Soil,    //!< grass may grow on it
    Leaf,    //!< moves in the wind
    Pane,    //!< of a window: may become a mirror, else it is solid
    Mirror,  //!< shows what is before it, as if it were behind it
};

/** Triangles with the share of light that each reflects. */
struct Mesh
{
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Vector3d> vertices;  //!< [m]
    std::vector<Triangle> triangles;
    std::vector<float> reflectivity;  //!< of each triangle, 0..1
    std::vector<Material> materials;  //!< of the first triangles; the others are solid

    /** Adds another mesh, moved by T. */
    void append(const Mesh& other, const Pose& T = {});

    /** Makes all triangles from `first` on of a material. */
    void mark(std::size_t first, Material material);
    Material materialOf(std::size_t triangle) const
    {
        return triangle < materials.size() ? materials[triangle] : Material::Solid;
    }
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

/** A rectangle of a wall that lies behind the wall's plane (depth > 0) or stands out of it (< 0).
 */
struct Recess
{
    double left = 0, right = 0;  //!< along the wall [m]
    double bottom = 0, top = 0;  //!< over its lower edge [m]
    double depth = 0;            //!< [m]
    float reflectivity = 0.5F;
    bool open = false;    //!< nothing at its back: a doorway
    bool window = false;  //!< its back is a pane
};

/** An upright wall with recesses that do not overlap. In the frame of T the wall spans x in [0,
 * length] and z in [0, height] in the plane y = 0; +y is behind it. */
void addWall(
    Mesh& mesh, const Pose& T, double length, double height, const std::vector<Recess>& recesses,
    float reflectivity);

/** A profile in the x-z plane of T, extruded by +-width/2 along its y. The profile is closed and
 * seen whole from its centroid. */
void addExtrusion(
    Mesh& mesh, const Pose& T, const std::vector<std::array<double, 2>>& profile, double width,
    float reflectivity);

/** A triangle mesh from a PLY (text or binary little endian) or OBJ file. Polygons are cut into
 * fans. Throws std::runtime_error naming the file and the cause. */
Mesh loadMesh(const std::string& path, float reflectivity);
}  // namespace taut::simulation
