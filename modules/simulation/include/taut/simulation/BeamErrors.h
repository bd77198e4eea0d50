#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "taut/core/Scan.h"

namespace taut::simulation
{
struct LidarConfig;

/** Systematic errors of one unit of a LiDAR: its lasers do not look exactly where the design says,
 * and measure a little short or long. Constant in time and the same for all shots of a ring; a
 * sensor without rings has one laser. Points are recorded along the angles of the design. */
class BeamErrors
{
 public:
    /** The unit that the seed names. */
    BeamErrors(const LidarConfig& config, int rings, std::uint64_t seed);

    /** Where a beam truly looks that by design looks along `direction`; unit, sensor frame. */
    Vector3d looking(const Vector3d& direction, std::uint16_t ring) const;

    double elevation(std::uint16_t ring) const { return lasers_[ring].elevation; }  //!< [rad]
    double range(std::uint16_t ring) const { return lasers_[ring].range; }          //!< [m]

    /** Where a recorded point would be without these errors; all in the sensor frame [m].
     * @param origin of the beam */
    Eigen::Vector3f removed(const LidarPoint& recorded, const Vector3d& origin) const;

    /** As removed() of all points of a sensor whose beams start in its origin. */
    Scan removed(Scan recorded) const;

 private:
    struct Laser
    {
        double elevation, range;
    };
    std::vector<Laser> lasers_;
};
}  // namespace taut::simulation
