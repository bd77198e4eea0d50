#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "taut/completion/TurnFinder.h"
#include "taut/core/Measurement.h"
#include "taut/core/Warning.h"
#include "taut/rawlog/ItemSource.h"
#include "taut/rawlog/LogGrowth.h"
#include "taut/rawlog/Rig.h"

namespace taut
{
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
    ScanTimes scan_times = ScanTimes::Auto;  //!< for scans without times of their points
    /** Opens `path` where it is a recording of another format; empty: it is a rawlog. Then the
     * measurements are those of the rawlog that an import of it would write. */
    OpenItems open;
    /** For a log that is being written. A stamp that follows the one before within a second is then
     * taken as good at once. Where all stamps are good, what is given out is the same as without.
     */
    WaitForGrowth wait_for_growth;
};

/** Whether a file begins with an object of a rawlog, gz or plain. */
bool isRawlog(const std::string& path);

/** Streams the measurements of one LiDAR and one IMU out of a rawlog (observation or sensory-frame
 * format, gz or plain; or what RawlogConfig::open gives), in the order of the file, with memory
 * bounded by about 3 s of it.
 *
 * The body is the IMU: T_imu_lidar = T_vehicle_imu^-1 T_vehicle_lidar from the sensors' poses in
 * the log (or the rig). Without an IMU the body is the vehicle.
 *
 * Sizes that are written in the file are not believed. An object larger than its file, or than any
 * scan, ends the reading as other damage does.
 *
 * Stamps of each sensor are strictly increasing in what is given out. What cannot be used is
 * skipped with a warning: rawlog_truncated   the file ends early or is damaged; see incomplete()
 *   no_stamp           observation without a valid stamp
 *   stamp_outlier      stamp seconds away from those around it
 *   imu_order          sample of the IMU up to a second late in the file (used, in its place)
 *   clock_back         clock set back by more than half a second: later stamps are moved forward by
 *                      as much (used; the same for both sensors if both clocks were)
 *   imu_time           stamp of the IMU earlier than the one before
 *   imu_duplicate      stamp of the IMU equal to the one before
 *   scan_time          stamp or end of a scan earlier than that of the one before
 *   scan_duplicate     stamp or end of a scan equal to that of the one before
 *   imu_invalid        values that are missing or not finite
 *   imu_outlier        values beyond ImuRig::max_accel or max_rate
 *   imu_units          values that contradict m/s^2 and rad/s (used as they are)
 *   imu_late           the IMU appeared later than 2 s into the log
 *   scan_overlap       a scan begins 20 ms or more before the end of the one before (used)
 *   scan_invalid       point vectors of different lengths, packets that cannot be decoded
 *   scan_empty         no valid point
 *   scan_bad_points    more than 5 % of the points not finite or with an impossible time (used)
 *   scan_point_times   less than 1 % of the points have a time that no sweep of this LiDAR can
 *                      reach, by the usual interval of its stamps: dropped (the others are used)
 *   scan_times         all points carry the same time: their times are told from their azimuth,
 *                      stamps being begins of sweeps unless the gyro tells otherwise (used)
 *   scan_undistorted   all points carry the same time (used, Scan::already_undistorted)
 *   rig_unused         a part of the rig describes another sensor than the one in use
 *   imu_not_found      an IMU label was asked for and the log ended without one
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
    StreamProgress progress() const override;
    bool incomplete() const override;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
