#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut::simulation
{
/** One shot of a laser. */
struct Shot
{
    Duration t =
        0;  //!< since the sensor started to turn [ns]; a multiple of 100 ns, the tick of rawlogs
    Vector3d direction = Vector3d::UnitX();  //!< unit, sensor frame
    std::uint16_t ring = 0;
};

/** When and where a LiDAR looks. */
class LidarPattern
{
 public:
    virtual ~LidarPattern() = default;
    /** The shots of sweep k = 0, 1, ..., in the order of time; sweeps do not overlap in time. */
    virtual std::vector<Shot> sweep(int k) const = 0;
    virtual Duration period() const = 0;  //!< of a sweep [ns]
    virtual int rings() const = 0;        //!< 0 if it has none
};

/** A laser of a spinning LiDAR. */
struct Laser
{
    double elevation = 0;  //!< [rad]
    double azimuth = 0;    //!< ahead of the turning head, clockwise [rad]
    double delay = 0;      //!< after the start of its firing sequence [s]
};

/** A head that turns clockwise, seen from above, and starts at +y: azimuth a looks at (sin a, cos
 * a), as the Velodyne manuals have it. */
std::unique_ptr<LidarPattern> makeSpinningPattern(
    std::vector<Laser> lasers, double firing_period, double rotation_rate);

/** Velodyne VLP-16, in the order of firing (laser number = ring). VLP-16 User Manual 63-9243 Rev.
 * D, table 9-1 (angles) and chapter 9.4 (2.304 us a laser, 55.296 us a firing sequence). */
std::unique_ptr<LidarPattern> makeVlp16Pattern(double rotation_rate);
}  // namespace taut::simulation
