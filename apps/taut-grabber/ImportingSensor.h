#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/system/COutputLogger.h>

#include "taut/core/Warning.h"
#include "taut/importing/ImportSource.h"
#include "taut/rawlog/RawlogWriter.h"

namespace taut
{
/** A sensor of rawlog-grabber that gives what taut's decoders read. Its section has, besides what
 * every section has, the labels `lidar_label` and `imu_label`, and the pose on the vehicle of the
 * IMU, or of a LiDAR without one: `pose_x`, `pose_y`, `pose_z` [m], `pose_yaw`, `pose_pitch`,
 * `pose_roll` [deg]. */
class ImportingSensor : public mrpt::hwdrivers::CGenericSensor,
                        protected mrpt::system::COutputLogger
{
 protected:
    explicit ImportingSensor(const std::string& name) : COutputLogger(name) {}

    void loadConfig_sensorSpecific(
        const mrpt::config::CConfigFileBase& config, const std::string& section) override;

    /** Hands the item to rawlog-grabber, as RawlogWriter writes it. */
    std::shared_ptr<mrpt::obs::CObservation> give(const ImportedItem& item);

    /** Prints warnings as rawlog-grabber prints its own, and counts them. */
    WarningSink warnings();
    std::size_t warned() const { return warned_; }

    std::size_t scans() const { return scans_; }  //!< given
    std::size_t samples() const { return samples_; }

 private:
    RawlogWriterConfig config_;
    std::size_t scans_ = 0, samples_ = 0, warned_ = 0;
};
}  // namespace taut
