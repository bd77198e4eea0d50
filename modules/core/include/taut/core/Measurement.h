#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"

namespace taut
{
using Measurement = std::variant<ImuSample, Scan>;

/** How far the reading is, and what was found up to there. */
struct StreamProgress
{
    Time first = 0;                //!< first stamp of a LiDAR or IMU
    Time now = 0;                  //!< latest stamp read
    std::uint64_t bytes_read = 0;  //!< of the file as it is on the disk: compressed if it is so
    std::uint64_t bytes_total = 0;
    std::size_t scans = 0, imu_samples = 0;  //!< given out
    std::size_t skipped = 0;   //!< observations of the chosen sensors that could not be used
    std::uint64_t points = 0;  //!< in the scans of the chosen LiDAR, dropped ones too
    std::uint64_t points_not_finite = 0;  //!< of these: a coordinate is NaN or infinite
    std::uint64_t points_bad_time = 0;    //!< of these: cannot be in their sweep
    bool has_imu = false;                 //!< an IMU was found, at the latest 2 s into the log
    std::string lidar_label, imu_label;   //!< as chosen; empty before the first of them
    /** Observations by label and MRPT class, of all sensors, used or not. The label of one that is
     * neither LiDAR nor IMU may be empty. Labels are valid UTF-8, as everywhere here. */
    std::map<std::pair<std::string, std::string>, std::size_t> sensors;
    /** False if nothing in the recording tells where the LiDAR is on the IMU: the identity is
     * assumed. A rawlog always tells. */
    bool pose_told = true;
    /** Of a recording of another format, at its end: what was found out about it and used (rates,
     * topics, units, poses), one line each. */
    std::vector<std::string> findings;

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
    virtual StreamProgress progress() const = 0;

    /** True at the end of a file that ended early or was damaged; the cause is in the warning. */
    virtual bool incomplete() const = 0;
};
}  // namespace taut
