/** taut-import: turns a recording of another format into a rawlog.
 * Exit codes: 0 done, 1 failed, 2 bad usage, 3 done, but part of the input could not be used. */
#include <cstdio>
#include <filesystem>
#include <type_traits>

#include "../CommandLine.h"
#include "../Progress.h"
#include "../Signals.h"
#include "../guardOutput.h"
#include "Options.h"
#include "SensorSummary.h"
#include "taut/core/NameExpression.h"
#include "taut/core/WarningLog.h"
#include "taut/importing/openImportSource.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/Rig.h"

namespace taut
{
namespace
{
const std::atomic<bool>& interrupted = interruption();

/** One run of the program: from a recording to a rawlog. */
class Import
{
 public:
    explicit Import(const Options& options)
        : options_(options),
          progress_(!options.quiet),
          warnings_([this](const Warning& w) { print(w); }),
          rig_(readRig())
    {
    }

    /** The exit code. */
    int execute()
    {
        const auto source = openImportSource(options_.source, options(), warnings_.sink());
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
    /** Without the parts that describe another sensor than the one that is written. */
    Rig readRig()
    {
        if (options_.rig.empty()) return {};
        Rig rig = loadRig(options_.rig);
        if (!matches(rig.lidar.label, options_.lidar_label)) rig.lidar = {};
        if (!matches(rig.imu.label, options_.imu_label)) rig.imu = {};
        return rig;
    }

    bool matches(const std::string& expression, const std::string& label)
    {
        if (NameExpression("the sensor label", expression).matches(label)) return true;
        warnings_.add(
            {0, "rig_unused",
             "the rig file describes '" + expression + "', but the label written is '" + label +
                 "'"});
        return false;
    }

    ImportOptions options() const
    {
        ImportOptions import = options_.import;
        if (rig_.imu.accel_scale != 1) import.accel_scale = rig_.imu.accel_scale;
        import.lidar_clock_offset = rig_.lidar.clock_offset;
        if (rig_.imu.gyro_scale != 1) import.gyro_scale = rig_.imu.gyro_scale;
        return import;
    }

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
        const Duration clock_offset = fromSeconds(rig_.lidar.clock_offset);
        scan.stamp += clock_offset;
        if constexpr (std::is_same_v<AnyScan, Scan>) scan.end += clock_offset;
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
        if (!options_.rig.empty())
            std::printf(
                "poses, units and clock of the rig file are in the rawlog: do not give it to "
                "taut-slam again\n");
    }

    const Options& options_;
    Progress progress_;
    WarningLog warnings_;
    Rig rig_;
    SensorSummary scans_, imu_;
};

int run(int argc, char** argv)
{
    Options options;
    if (!parseOptions(argc, argv, options)) return 0;
    guardOutput(
        options.output, {options.source, options.rig, options.import.ouster_json}, isRawlog);
    if (!options.overwrite && std::filesystem::exists(options.output))
        throw UsageError("'" + options.output + "' is there already; -w overwrites it");
    catchSignals();
    return Import(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram("taut-import", [&] { return taut::run(argc, argv); });
}
