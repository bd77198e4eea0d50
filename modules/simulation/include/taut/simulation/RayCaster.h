#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "taut/simulation/Mesh.h"

namespace taut::simulation
{
/** Where a ray meets a surface. */
struct Hit
{
    double range = 0;                     //!< [m]
    Vector3d normal = Vector3d::UnitZ();  //!< unit, towards the origin of the ray
    float reflectivity = 0;
    std::uint32_t triangle = 0;
    Material material = Material::Solid;
};

/** Ray casting in a mesh (Embree). The triangle is found in single precision and then intersected
 * again in double: the point lies on its plane to the precision of doubles. Threads may share one.
 */
class RayCaster
{
 public:
    explicit RayCaster(Mesh mesh);
    ~RayCaster();
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;

    /** The first surface along a ray within max_range, if any. `direction` is of unit length. */
    std::optional<Hit> cast(
        const Vector3d& origin, const Vector3d& direction, double max_range) const;

    /** Distance from a point to the nearest surface [m]; infinity if none within max_distance. */
    double clearance(const Vector3d& point, double max_distance) const;

    const Mesh& mesh() const;

 private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};
}  // namespace taut::simulation
