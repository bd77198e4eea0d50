/** taut-import: turns a recording of another format into a rawlog.
 * Exit codes: 0 done, 1 failed, 2 bad usage, 3 done, but part of the input could not be used. */
#include <cstdio>
#include <filesystem>

#include "../CommandLine.h"
#include "../Progress.h"
#include "../Signals.h"
#include "../guardOutput.h"
#include "Options.h"
#include "taut/core/WarningLog.h"
#include "taut/importing/Import.h"
#include "taut/rawlog/RawlogSource.h"

namespace taut
{
namespace
{
const std::atomic<bool>& interrupted = interruption();

/** One run of the program: from a recording to a rawlog. */
class Run
{
 public:
    explicit Run(const Options& options)
        : options_(options),
          progress_(!options.quiet),
          warnings_([this](const Warning& w) { print(w); })
    {
        config_.path = options.source;
        config_.options = options.import;
        if (!options.rig.empty()) config_.rig = loadRig(options.rig);
        config_.lidar_label = options.lidar_label;
        config_.imu_label = options.imu_label;
    }

    /** The exit code. */
    int execute()
    {
        Import import(config_, warnings_.sink());
        RawlogWriterConfig config;
        config.lidar_label = options_.lidar_label;
        config.imu_label = options_.imu_label;
        config.T_vehicle_imu = import.T_vehicle_imu();
        RawlogWriter writer(options_.output, config);
        copy(import, writer);
        report(import);
        if (import.scans() == 0)
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

    void copy(Import& import, RawlogWriter& writer)
    {
        while (!interrupted)
        {
            const auto item = import.next();
            if (!item) break;
            std::visit([&](const auto& i) { writer.write(i); }, *item);
            progress_.update(
                import.progress(), static_cast<int>(import.scans()), toSeconds(import.span()));
        }
        progress_.clear();
        if (interrupted) std::fprintf(stderr, "interrupted: saving what was read\n");
    }

    void report(const Import& import) const
    {
        std::fputs(warnings_.summaryOfRest().c_str(), stderr);
        if (options_.quiet) return;
        for (const std::string& finding : import.findings()) std::printf("%s\n", finding.c_str());
        if (!options_.rig.empty())
            std::printf(
                "poses, units and clock of the rig file are in the rawlog: do not give it to "
                "taut-slam again\n");
    }

    const Options& options_;
    Progress progress_;
    WarningLog warnings_;
    ImportConfig config_;
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
    return Run(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-import", [&] { return taut::run(argc, argv); }, {argv, argv + argc});
}
