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
    Vector3d origin = Vector3d::Zero();      //!< of the beam, sensor frame [m]
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
    virtual Duration packet() const = 0;  //!< of the shots that one packet holds [ns]
    virtual int rings() const = 0;        //!< 0 if it has none
};

/** A laser of a spinning LiDAR. */
struct Laser
{
    double elevation = 0;  //!< [rad]
    double azimuth = 0;    //!< ahead of the turning head, clockwise [rad]
    double delay = 0;      //!< after the start of its firing sequence [s]
};

/** A head that turns clockwise, seen from above, and starts at +x: azimuth a looks at (cos a, -sin
 * a). The beams start `beam_origin` [m] off the axis, where the head looks to. A packet holds
 * `packet_firings` sequences. */
std::unique_ptr<LidarPattern> makeSpinningPattern(
    std::vector<Laser> lasers, double firing_period, double rotation_rate, double beam_origin = 0,
    int packet_firings = 1);

/** Velodyne VLP-16: 16 lasers in the order of firing. User Manual 63-9243: 2.304 us a laser, 55.296
 * us a firing sequence, elevations -15 1 -13 3 ... -1 15 degrees. */
std::unique_ptr<LidarPattern> makeVlp16Pattern(double rotation_rate);

/** Velodyne HDL-32E: 32 lasers in the order of firing. User Manual 63-9113: 1.152 us a laser, 46.08
 * us a firing sequence, elevations -30.67 -9.33 -29.33 -8 ... -10.67 10.67 degrees. */
std::unique_ptr<LidarPattern> makeHdl32Pattern(double rotation_rate);

/** Velodyne HDL-64E S2. User's Manual 63-HDL64ES2: upper block +2 to -8.33 degrees in steps of 1/3,
 * lower block -8.83 to -24.33 in steps of 1/2; laser i of one block fires in unison with laser i of
 * the other. The sequence of 48 us (1.333 million points a second) is spread evenly over the pairs,
 * which the manual's table does only nearly. */
std::unique_ptr<LidarPattern> makeHdl64Pattern(double rotation_rate);

/** Ouster OS1 with 64 or 128 rows and 1024 columns a turn; all rows of a column fire at once.
 * OS1-64 (Gen 1 data sheet): 33.2 degrees in even steps, azimuths staggered by 2.11 degrees over
 * four rows. OS1-128 (metadata of a unit): 42.8 degrees in even steps, staggered by 2.81. Beams
 * start 12.163 mm (Gen 1) and 15.806 mm (later) off the axis: lidar_origin_to_beam_origin_mm, as
 * the manufacturer's SDK takes it by default and the metadata of the unit say. */
std::unique_ptr<LidarPattern> makeOs1Pattern(int rows, double rotation_rate);

/** A rosette that never repeats, as of a Livox Mid-70: 100,000 points a second in a circle of 70.4
 * degrees around x, drawn by two prisms that turn at 7294 and -4664 rpm (speeds of the Mid-40:
 * Brazeal et al., Sensors 2021, 21(14), 4722). A sweep is merely a span of time. No rings. */
std::unique_ptr<LidarPattern> makeRosettePattern(double sweep_rate);
}  // namespace taut::simulation
