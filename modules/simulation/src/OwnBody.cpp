#include "OwnBody.h"

namespace taut::simulation
{
namespace
{
void addBoxAt(Mesh& mesh, const Vector3d& middle, const Vector3d& size, float reflectivity)
{
    addBox(mesh, {Matrix3d::Identity(), middle}, size, reflectivity);
}

/** Somebody who holds the sensor before the chest: trunk, head, and the arm that holds it. */
Mesh person()
{
    Mesh mesh;
    addFrustum(mesh, {-0.72, 0, -1.2}, {-0.72, 0, 0.02}, 0.18, 0.22, 16, 0.5F);
    addFrustum(mesh, {-0.68, 0, 0.1}, {-0.68, 0, 0.36}, 0.09, 0.08, 12, 0.4F);
    addFrustum(mesh, {-0.7, -0.25, -0.05}, {-0.3, -0.2, -0.35}, 0.05, 0.045, 10, 0.5F);
    addFrustum(mesh, {-0.3, -0.2, -0.35}, {0, 0, -0.25}, 0.045, 0.03, 10, 0.5F);
    return mesh;
}

/** Roof and bonnet of a car, a rack behind the sensor and an aerial. */
Mesh car()
{
    Mesh mesh;
    addBoxAt(mesh, {-0.3, 0, -0.55}, {2.0, 1.3, 0.1}, 0.5F);
    addBoxAt(mesh, {1.6, 0, -1.05}, {1.2, 1.6, 0.1}, 0.5F);
    addBoxAt(mesh, {-1.0, 0, -0.3}, {0.08, 1.2, 0.12}, 0.3F);
    addFrustum(mesh, {-1.1, 0.4, -0.5}, {-1.15, 0.4, 0.35}, 0.02, 0.012, 8, 0.3F);
    return mesh;
}

/** Arms with motors above a sensor that hangs upside down (its z points down), and landing legs. */
Mesh multicopter()
{
    Mesh mesh;
    for (const int x : {-1, 1})
        for (const int y : {-1, 1})
        {
            addFrustum(
                mesh, {0.1 * x, 0.1 * y, -0.16}, {0.5 * x, 0.5 * y, -0.16}, 0.015, 0.012, 8, 0.3F);
            addFrustum(
                mesh, {0.5 * x, 0.5 * y, -0.2}, {0.5 * x, 0.5 * y, -0.13}, 0.03, 0.03, 10, 0.4F);
            addFrustum(
                mesh, {0.4 * x, 0.4 * y, -0.16}, {0.46 * x, 0.46 * y, 0.25}, 0.012, 0.012, 8, 0.3F);
        }
    return mesh;
}
}  // namespace

Mesh makeOwnBody(OwnBody kind)
{
    switch (kind)
    {
        case OwnBody::Person:
            return person();
        case OwnBody::Car:
            return car();
        case OwnBody::Multicopter:
            return multicopter();
        case OwnBody::None:
            break;
    }
    return {};
}
}  // namespace taut::simulation
