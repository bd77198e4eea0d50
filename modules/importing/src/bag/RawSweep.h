#pragma once

#include <stdexcept>
#include <vector>

#include "Messages.h"
#include "taut/core/Scan.h"

namespace taut::bag
{
/** No cloud of the recording can be used before it is told what its fields mean. */
struct FieldError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** A cloud whose times are still as the message has them. */
struct RawSweep
{
    Time header = 0;     //!< stamp of the message
    Time received = 0;   //!< when the recorder took it
    Time base = 0;       //!< to add to the points' times [ns]; 0 if those are all there is
    std::string sensor;  //!< lidar_id of Livox, or frame_id
    std::vector<LidarPoint> points;  //!< finite, not at the origin; offsets not set
    std::vector<double> times;       //!< of the points, in the field's unit; empty if it has none
    std::string time_field;          //!< "t (uint32)"
    double nominal_unit = 1;         //!< what that field usually has [ns]; 0 if it varies
    bool single_precision = false;   //!< that field is a float32
    int rings = 0;                   //!< as Scan::rings
    std::size_t bad_times = 0;       //!< points left out for a time that is not finite
};

/** Finds x, y, z, intensity (or reflectivity), ring (line, channel, laser_id) and time
 * (TimeField.h; `time_field` is the one asked for) by name. Throws std::runtime_error if the layout
 * contradicts itself; FieldError if it is not clear which field has the times. */
RawSweep toRawSweep(const PointCloud2& cloud, const std::string& time_field = {});
RawSweep toRawSweep(const Livox& sweep);
}  // namespace taut::bag
