#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"
#include "taut/rawlog/Rig.h"

namespace taut
{
using Measurement = std::variant<ImuSample, Scan>;

/** What to read of which rawlog. Label expressions are ECMAScript and must match the whole label.
 */
struct RawlogConfig
{
    std::string path;
    std::string lidar_label;  //!< regular expression; empty = the rig's, or the only LiDAR there
    std::string imu_label;    //!< regular expression; empty = the rig's, or the only IMU there
    double from_time = 0;     //!< [s] since the log's first stamp; 0 = all of it
    double to_time = std::numeric_limits<double>::infinity();  //!< [s]; no scan begins later
    int only_first_n = 0;  //!< end after that many scans; 0 = all
    Rig rig;               //!< what overrides the poses, units and clocks of the log
};

/** How far the reading is, and what was found up to there. */
struct RawlogProgress
{
    Time first = 0;                //!< first stamp of a LiDAR or IMU
    Time now = 0;                  //!< latest stamp read
    std::uint64_t bytes_read = 0;  //!< of the file as it is on the disk: compressed if it is so
    std::uint64_t bytes_total = 0;
    std::size_t scans = 0, imu_samples = 0;  //!< given out
    std::size_t skipped = 0;   //!< observations of the chosen sensors that could not be used
    std::uint64_t points = 0;  //!< in the scans of the chosen LiDAR, dropped ones too
    std::uint64_t points_not_finite = 0;  //!< of these: a coordinate is NaN or infinite
    std::uint64_t points_bad_time = 0;    //!< of these: 2 s or more away from their scan's stamp
    bool has_imu = false;                 //!< an IMU was found, at the latest 2 s into the log
    std::string lidar_label, imu_label;   //!< as chosen; empty before the first of them
    /** Observations by label and MRPT class, of all sensors, used or not. */
    std::map<std::pair<std::string, std::string>, std::size_t> sensors;

    /** 0 to 1, of the file: for a bar. */
    double fraction() const
    {
        return bytes_total ? static_cast<double>(bytes_read) / static_cast<double>(bytes_total) : 0;
    }
};

/** Measurements one after the other. */
class MeasurementStream
{
 public:
    MeasurementStream() = default;
    virtual ~MeasurementStream() = default;
    MeasurementStream(const MeasurementStream&) = delete;
    MeasurementStream& operator=(const MeasurementStream&) = delete;

    /** The next measurement, or nothing at the end. */
    virtual std::optional<Measurement> next() = 0;

    /** As of the measurement last given out. */
    virtual RawlogProgress progress() const = 0;

    /** True at the end of a file that ended early or was damaged; the cause is in the warning. */
    virtual bool incomplete() const = 0;
};

/** Streams the measurements of one LiDAR and one IMU out of a rawlog (observation or sensory-frame
 * format, gz or plain), in the order of the file, with memory bounded by about 2 s of it.
 *
 * The body is the IMU: T_imu_lidar = T_vehicle_imu^-1 T_vehicle_lidar from the sensors' poses in
 * the log (or the rig). Without an IMU the body is the vehicle.
 *
 * Stamps of each sensor are strictly increasing in what is given out. What cannot be used is
 * skipped with a warning: rawlog_truncated   the file ends early or is damaged; see incomplete()
 *   no_stamp           observation without a valid stamp
 *   imu_time           stamp of the IMU earlier than the one before
 *   imu_duplicate      stamp of the IMU equal to the one before
 *   scan_time          stamp or end of a scan earlier than that of the one before
 *   scan_duplicate     stamp or end of a scan equal to that of the one before
 *   imu_invalid        values that are missing or not finite
 *   imu_units          values that contradict m/s^2 and rad/s (used as they are)
 *   imu_late           the IMU appeared later than 2 s into the log
 *   scan_overlap       a scan begins 20 ms or more before the end of the one before (used)
 *   scan_invalid       point vectors of different lengths, packets that cannot be decoded
 *   scan_empty         no valid point
 *   scan_bad_points    more than 5 % of the points not finite or with an impossible time (used)
 *   scan_undistorted   all points carry the same time (used, Scan::already_undistorted)
 *   rig_unused         a part of the rig describes another sensor than the one in use
 *   no_imu             an IMU label was asked for and the log ended without one
 *
 * Scan::end is the time of the last point, the dropped ones included: they tell the end of the
 * sweep as well as the others. */
class RawlogSource : public MeasurementStream
{
 public:
    /** Opens the log and reads its first 2 s. Throws std::runtime_error, naming the file, if it is
     * missing, empty or no rawlog, and if a label is ambiguous. */
    explicit RawlogSource(const RawlogConfig& config, WarningSink warn = {});
    ~RawlogSource() override;

    /** Throws std::runtime_error if a second sensor of a kind appears, or if the whole log had no
     * LiDAR. */
    std::optional<Measurement> next() override;
    RawlogProgress progress() const override;
    bool incomplete() const override;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
