#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "ImportArguments.h"
#include "SensorArguments.h"
#include "taut/importing/Import.h"
#include "taut/importing/openImportSource.h"

namespace taut
{
/** The options of every program that reads a recording: rig, sensors, part of the time, and how a
 * recording that is no rawlog is to be read. */
class LogArguments : public SensorArguments
{
 public:
    /** As SensorArguments. */
    explicit LogArguments(TCLAP::CmdLine& cmd)
        : SensorArguments(cmd),
          from_(
              "", "from-time", "Leave out what is earlier: seconds since the start of the log",
              false, 0, "SECONDS", cmd),
          to_("", "to-time", "End there: seconds since the start of the log", false,
              std::numeric_limits<double>::infinity(), "SECONDS", cmd),
          import_(cmd)
    {
    }

    /** What the options say of the recording in `path`. Throws UsageError if the part of the time
     * is none or an option is for another kind of recording, ConfigError for the rig file. */
    RawlogConfig log(const std::string& path)
    {
        RawlogConfig config;
        config.path = path;
        config.lidar_label = lidarLabel();
        config.imu_label = imuLabel();
        config.to_time = toTime();
        config.from_time = from_.getValue();
        if (!rig().empty()) config.rig = loadRig(rig());
        ImportOptions options = import_.options();
        options.scan_times = config.scan_times = scanTimes();
        if (canBeImported(path))
        {
            if (choosesByLabel())
                throw UsageError(
                    "--lidar and --imu choose by label in a rawlog, which '" + path +
                    "' is not; in a bag --lidar-topic and --imu-topic do");
            readByImport(config, options);
            config.scan_times = ScanTimes::None;  // the import has told them
        }
        else if (!import_.given().empty() && std::filesystem::exists(path))
        {
            throw UsageError(
                import_.given() + " is for captures and bags, and '" + path + "' is none");
        }
        return config;
    }

 private:
    double toTime()
    {
        if (from_.getValue() < 0 || !(to_.getValue() > from_.getValue()))
            throw UsageError("--to-time must be later than --from-time, and neither negative");
        constexpr double kLongest = 1e9;  // [s], 30 years: stamps reach no further
        if (from_.getValue() > kLongest)
            throw UsageError("--from-time is more than the 1e9 s that a log can take");
        return to_.getValue();
    }

    TCLAP::ValueArg<double> from_, to_;
    ImportArguments import_;
};
}  // namespace taut
