/** taut-import: turns a recording of another format into a rawlog.
 * Exit codes: 0 done, 1 failed, 2 bad usage, 3 done, but part of the input could not be used. */
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "../CommandLine.h"
#include "../Progress.h"
#include "Options.h"
#include "SensorSummary.h"
#include "taut/core/WarningLog.h"
#include "taut/importing/openImportSource.h"
#include "taut/rawlog/Rig.h"

namespace taut
{
namespace
{
std::atomic<bool> interrupted{false};
void onSignal(int)
{
    interrupted = true;
}

/** One run of the program: from a recording to a rawlog. */
class Import
{
 public:
    explicit Import(const Options& options)
        : options_(options),
          rig_(options.rig.empty() ? Rig{} : loadRig(options.rig)),
          progress_(!options.quiet),
          warnings_([this](const Warning& w) { print(w); })
    {
    }

    /** The exit code. */
    int execute()
    {
        ImportOptions import = options_.import;
        if (rig_.imu.accel_scale != 1) import.accel_scale = rig_.imu.accel_scale;
        if (rig_.imu.gyro_scale != 1) import.gyro_scale = rig_.imu.gyro_scale;
        const auto source = openImportSource(options_.source, import, warnings_.sink());
        RawlogWriterConfig config;
        config.lidar_label = options_.lidar_label;
        config.imu_label = options_.imu_label;
        if (rig_.imu.T_vehicle_imu) config.T_vehicle_imu = *rig_.imu.T_vehicle_imu;
        RawlogWriter writer(options_.output, config);
        copy(*source, writer);
        report(*source);
        if (scans_.count() == 0)
            throw std::runtime_error("no scan in '" + options_.source + "'; nothing was written");
        writer.close();
        return interrupted || !warnings_.counts().empty() ? 3 : 0;
    }

 private:
    void print(const Warning& w)
    {
        progress_.clear();
        std::fprintf(stderr, "warning [%s]: %s\n", w.kind.c_str(), w.text.c_str());
    }

    void copy(ImportSource& source, RawlogWriter& writer)
    {
        while (!interrupted)
        {
            auto item = source.next();
            if (!item) break;
            std::visit([&](auto& i) { add(i, writer); }, *item);
            progress_.update(
                source.progress(), static_cast<int>(scans_.count()), toSeconds(scans_.span()));
        }
        progress_.clear();
        if (interrupted) std::fprintf(stderr, "interrupted: saving what was read\n");
    }

    void add(ImuSample& sample, RawlogWriter& writer)
    {
        imu_.add(sample.t);
        writer.write(sample);
    }

    template <class AnyScan>
    void add(AnyScan& scan, RawlogWriter& writer)
    {
        scans_.add(scan.stamp);
        if (rig_.lidar.T_vehicle_lidar)
            scan.T_imu_lidar =
                rig_.imu.T_vehicle_imu.value_or(Pose{}).inverse() * *rig_.lidar.T_vehicle_lidar;
        writer.write(scan);
    }

    void report(const ImportSource& source) const
    {
        std::fputs(warnings_.summaryOfRest().c_str(), stderr);
        if (options_.quiet) return;
        std::printf("LiDAR '%s': %s\n", options_.lidar_label.c_str(), scans_.text().c_str());
        std::printf("IMU '%s': %s\n", options_.imu_label.c_str(), imu_.text().c_str());
        for (const std::string& finding : source.findings()) std::printf("%s\n", finding.c_str());
    }

    const Options& options_;
    Rig rig_;
    Progress progress_;
    WarningLog warnings_;
    SensorSummary scans_, imu_;
};

int run(int argc, char** argv)
{
    Options options;
    if (!parseOptions(argc, argv, options)) return 0;
    if (!options.overwrite && std::filesystem::exists(options.output))
        throw UsageError("'" + options.output + "' is there already; -w overwrites it");
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    return Import(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram("taut-import", [&] { return taut::run(argc, argv); });
}
