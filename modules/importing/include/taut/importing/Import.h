#pragma once

#include <memory>
#include <string>

#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"
#include "taut/importing/ImportSource.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/Rig.h"

namespace taut
{
/** A recording of another format, and what its user knows about it. */
struct ImportConfig
{
    std::string path;
    ImportOptions options;
    Rig rig;  //!< poses, scales and the clock offset go before what the recording tells
    std::string lidar_label = "LIDAR", imu_label = "IMU";  //!< what a rig's labels have to match
};

/** One import: the recording with the rig applied, and a summary of its sensors. */
class Import : public ItemSource
{
 public:
    /** Throws what openImportSource() throws, and ConfigError for a label that is no regular
     * expression. Warnings: those of the format, and
     *   rig_unused   a part of the rig describes another sensor (by its label) */
    Import(const ImportConfig& config, const WarningSink& warn);
    ~Import() override;

    std::optional<RecordedItem> next() override;
    double progress() const override;
    /** Counts, rates and gaps of the sensors, then what the format found out. */
    std::vector<std::string> findings() const override;
    std::size_t leftOut() const override;
    bool tellsPose() const override;

    /** Pose of the IMU on the vehicle: of the rig, else the identity. */
    Pose T_vehicle_imu() const;
    std::size_t scans() const;
    Duration span() const;  //!< of the stamps of the scans

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** Lets a RawlogSource read `config.path`, a recording that can be imported, as if it was the
 * rawlog that an import makes of it. `config.rig` keeps what a rawlog does not hold (noise, beams,
 * ranges); the rest of it goes to the import. Throws ConfigError as Import does. */
void readByImport(RawlogConfig& config, const ImportOptions& options);
}  // namespace taut
