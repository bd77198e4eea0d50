#pragma once

#include <vector>

#include "numeric.h"
#include "taut/core/Map.h"

namespace taut::test
{
/** A square piece of a plane, or of a line along `u`, with noise across it. */
struct Patch
{
    Vector3d center, u, v;  //!< u and v are unit vectors, orthogonal
    double radius = 4;      //!< half its edge [m]
    double noise = 0.01;    //!< [m]

    Vector3d normal() const { return u.cross(v); }

    Vector3d at(Random& random, double share) const
    {
        return center + share * radius * (random.uniform(-1, 1) * u + random.uniform(-1, 1) * v);
    }

    std::vector<MapPoint> planePoints(Random& random, int count, FeatureKind kind) const
    {
        std::vector<MapPoint> points;
        for (int i = 0; i < count; i++)
            points.push_back({at(random, 1) + noise * random.normal() * normal(), kind});
        return points;
    }

    std::vector<MapPoint> linePoints(Random& random, int count) const
    {
        std::vector<MapPoint> points;
        for (int i = 0; i < count; i++)
            points.push_back(
                {center + radius * random.uniform(-1, 1) * u + random.vector(noise),
                 FeatureKind::Edge});
        return points;
    }
};

inline Patch tiltedPatch(const Vector3d& center)
{
    const Vector3d normal = Vector3d(0.3, -0.5, 0.8).normalized();
    const Vector3d u = normal.cross(Vector3d::UnitX()).normalized();
    return {center, u, normal.cross(u)};
}
}  // namespace taut::test
