#pragma once

#include <optional>
#include <string>

#include "taut/completion/TurnFinder.h"

namespace taut
{
/** Which end of its sweep the stamp of a cloud is. */
enum class ScanStamp
{
    Detect,  //!< as the times of the points tell, or when the recorder got it
    Start,
    End
};

/** What a user can say about a recording that is to be imported. A format takes what concerns it.
 */
struct ImportOptions
{
    std::string ouster_json;     //!< description of the Ouster; empty: the capture's, with .json
    std::string hesai_csv;       //!< correction file of the Hesai; empty: one beside the recording
    bool capture_clock = false;  //!< stamps by the capturing computer instead of the sensor

    /** Bags: regular expressions (ECMAScript) for the whole name of a topic. */
    std::string lidar_topic;  //!< empty: the only one of point clouds
    std::string imu_topic;    //!< empty: the only one of readings, if there is one
    ScanStamp scan_stamp = ScanStamp::Detect;

    /** Clouds without times of their points. */
    ScanTimes scan_times = ScanTimes::Auto;
    /** Bags and folders: name of the field or column that has the times of the points; empty: found
     * by its name; "none": there are no times. */
    std::string time_field;

    /** Bags with the sweeps of several sensors on one topic: the lidar_id of Livox, or the frame_id
     * of the clouds. Empty: there is one. */
    std::string lidar_id;

    /** What will be added to the LiDAR's stamps after the import [s]: clocks are compared with it.
     */
    double lidar_clock_offset = 0;

    /** The pose of the LiDAR on the IMU is told otherwise (a rig): it is not looked for. */
    bool pose_given = false;

    /** Factors to m/s^2 and rad/s; nothing: judged by gravity. */
    std::optional<double> accel_scale, gyro_scale;
};
}  // namespace taut
