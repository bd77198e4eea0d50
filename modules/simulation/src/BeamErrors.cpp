#include "taut/simulation/BeamErrors.h"

#include <algorithm>
#include <cmath>

#include "taut/simulation/Lidar.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
BeamErrors::BeamErrors(const LidarConfig& config, int rings, std::uint64_t seed)
{
    Random random(seed, 30);
    for (int ring = 0; ring < std::max(1, rings); ring++)
    {
        const double elevation = config.beam_error * random.normal();
        const double range = config.range_bias + config.beam_range_error * random.normal();
        lasers_.push_back({elevation, range});
    }
}

Vector3d BeamErrors::looking(const Vector3d& direction, std::uint16_t ring) const
{
    const double angle = elevation(ring);
    if (angle == 0) return direction;
    const Vector3d up = (Vector3d::UnitZ() - direction.z() * direction).normalized();
    return std::cos(angle) * direction + std::sin(angle) * up;
}

Eigen::Vector3f BeamErrors::removed(const LidarPoint& recorded, const Vector3d& origin) const
{
    if (elevation(recorded.ring) == 0 && range(recorded.ring) == 0) return recorded.position;
    const Vector3d beam = recorded.position.cast<double>() - origin;
    const double length = beam.norm();
    const Vector3d direction = looking(beam / length, recorded.ring);
    return (origin + (length - range(recorded.ring)) * direction).cast<float>();
}

Scan BeamErrors::removed(Scan recorded) const
{
    for (LidarPoint& point : recorded.points) point.position = removed(point, Vector3d::Zero());
    return recorded;
}
}  // namespace taut::simulation
