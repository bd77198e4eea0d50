#include "Stairs.h"

namespace taut::simulation::stairs
{
void addFlight(Mesh& mesh, double z, bool forward, double side)
{
    for (int i = 0; i < kSteps; i++)
    {
        const double along = kLanding + (i + 0.5) * kRun;
        const double x = forward ? along : kLength - along;
        const Vector3d center(x, side * (kEye / 2 + kFlightWidth / 2), z + (i + 1) * kRise - 0.15);
        addBox(mesh, {Matrix3d::Identity(), center}, {kRun, kFlightWidth, 0.3}, 0.45F);
    }
    const double x0 = forward ? kLanding : kLength - kLanding;
    const double x1 = forward ? kLength - kLanding : kLanding;
    const double y = side * (kEye / 2 + 0.04);
    for (int i = 0; i <= 5; i++)  // banisters
    {
        const double f = i / 5.0, x = x0 + f * (x1 - x0), bottom = z + f * kHalfStorey;
        addFrustum(mesh, {x, y, bottom - 0.1}, {x, y, bottom + 0.9}, 0.02, 0.02, 8, 0.5F);
    }
    addFrustum(mesh, {x0, y, z + 0.95}, {x1, y, z + kHalfStorey + 0.95}, 0.03, 0.03, 8, 0.6F);
}

void addLanding(Mesh& mesh, double z, double x)
{
    addBox(
        mesh, {Matrix3d::Identity(), {x, 0, z - kSlab / 2}}, {kLanding, 2 * kHalfWidth, kSlab},
        0.4F);
}
}  // namespace taut::simulation::stairs
