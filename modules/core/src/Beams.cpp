#include "taut/core/Beams.h"

#include <cmath>
#include <stdexcept>

namespace taut
{
BeamDerivative beamDerivative(const Vector3d& p)
{
    const double flat = std::hypot(p.x(), p.y());
    return {p.normalized(), {-p.z() * p.x() / flat, -p.z() * p.y() / flat, flat}};
}

Vector3d withBeamChanged(const Vector3d& p, double elevation, double range)
{
    const double flat = std::hypot(p.x(), p.y());
    if (flat == 0) return p;
    const double new_range = p.norm() + range;
    const double new_elevation = std::atan2(p.z(), flat) + elevation;
    const double scale = new_range * std::cos(new_elevation) / flat;
    return {scale * p.x(), scale * p.y(), new_range * std::sin(new_elevation)};
}

void correctBeams(Scan& scan, const BeamCorrections& corrections)
{
    if (corrections.empty()) return;
    if (static_cast<std::size_t>(scan.rings) != corrections.elevation.size())
        throw std::runtime_error(
            "the rig file has beams of " + std::to_string(corrections.elevation.size()) +
            " rings, the sensor has " + std::to_string(scan.rings));
    for (LidarPoint& p : scan.points)
        p.position =
            withBeamChanged(
                p.position.cast<double>(), corrections.elevation[p.ring], corrections.range[p.ring])
                .cast<float>();
}
}  // namespace taut
