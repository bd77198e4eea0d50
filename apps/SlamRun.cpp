#include "SlamRun.h"

#include <mrpt/system/os.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "methodFile.h"
#include "taut/core/TimeText.h"
#include "taut/core/format.h"
#include "taut/session/ResultFolder.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
KnownMap knownMap(const SlamOptions& o)
{
    if (!fs::is_directory(o.map)) throw std::runtime_error("'" + o.map + "' is not a folder");
    if (!fs::exists(fs::path(o.map) / "graph.g2o"))
        throw std::runtime_error(
            "'" + o.map + "' holds no map: graph.g2o is missing, which taut-slam writes");
    KnownMap map{o.map, o.extend_map, {}};
    const std::vector<double>& at = o.start_at;
    if (!at.empty()) map.T_map_start = Pose{expSO3({0, 0, at[3]}), {at[0], at[1], at[2]}};
    return map;
}

std::string linesOf(const LiveSummary& live)
{
    std::string lines = format("load %.0f %%", 100 * live.load);
    if (live.scans > 0)
        lines += format(
            ", poses after %.0f ms (median), %.0f ms (99 %%), %.0f ms (worst)", 1e3 * live.median,
            1e3 * live.percentile_99, 1e3 * live.worst);
    for (const LiveSummary::Reduced& r : live.reduced)
        lines += format(
            "\nonly %.0f %% of each scan was used for %.1f s from %s s on", 100 * r.share,
            toSeconds(r.to - r.from), formatSeconds(r.from).c_str());
    return lines + "\n";
}
}  // namespace

void loadPlugins(const std::vector<std::string>& plugins)
{
    for (const std::string& plugin : plugins)
    {
        std::string error;
        if (!mrpt::system::loadPluginModule(plugin, error))
            throw ConfigError("plug-in '" + plugin + "' cannot be loaded: " + error);
    }
}

SlamRun::SlamRun(const SlamOptions& options, PoseStream::WhereNobodyReads stream)
    : options_(options),
      progress_(options.verbosity >= 2),
      second_pass_(options.verbosity >= 2),
      warnings_([this](const Warning& w) { print(w); })
{
    if (!options.rig.empty())
    {
        session_.rig = readTextFile(options.rig);
        rig_ = parseRig(session_.rig, options.rig);
    }
    session_.method_file = findMethodFile(options.config);
    ConfigSection root = readMethodFile(session_.method_file, options.settings);
    session_.method = Method::read(root, rig_.imu.noise);
    session_.folder = options.output;
    session_.threads = options.threads;
    if (!options.map.empty()) session_.known_map = knownMap(options);
    session_.pictures = !options.no_pictures;
    session_.report = !options.no_report;
    if (options.stream) stream_ = std::make_unique<PoseStream>(stream, warnings_.sink());
}

RawlogConfig SlamRun::rawlog(const std::string& path) const
{
    RawlogConfig c;
    c.path = path;
    c.lidar_label = options_.lidar_label;
    c.imu_label = options_.imu_label;
    c.rig = rig_;
    c.scan_times = options_.scan_times;
    return c;
}

void SlamRun::makeFolder(const std::vector<std::string>& inputs) const
{
    if (!options_.map.empty() && fs::exists(options_.output) &&
        fs::equivalent(options_.map, options_.output))
        throw UsageError("-o is the folder of -m: the map would be overwritten");
    for (const std::string& input : inputs)
        if (fs::is_directory(input) && fs::exists(options_.output) &&
            fs::equivalent(input, options_.output))
            throw UsageError(
                "the results would be mixed with the recording: choose another folder");
    try
    {
        prepareResultFolder(options_.output, options_.overwrite, inputs);
    }
    catch (const FolderInUse& e)
    {
        throw UsageError(e.what());
    }
}

void SlamRun::print(const Warning& w)
{
    if (options_.verbosity < 1) return;
    progress_.clear();
    std::fprintf(
        stderr, "warning [%s] at %s s: %s\n", w.kind.c_str(), formatSeconds(w.t).c_str(),
        w.text.c_str());
}

void SlamRun::tell(const std::string& line)
{
    if (options_.verbosity < 2) return;
    progress_.clear();
    second_pass_.clear();
    std::fprintf(stderr, "%s\n", line.c_str());
}

void SlamRun::take(const Event& event)
{
    if (stream_) stream_->add(event);
    const auto* estimated = std::get_if<Estimated>(&event);
    if (options_.verbosity < 3 || estimated == nullptr) return;
    const ScanResult& r = estimated->result;
    progress_.clear();
    std::fprintf(
        stderr, "%s: %d of %d features matched, %d iterations, %.1f ms\n",
        formatSeconds(r.estimate.state.t).c_str(), r.report.correspondences, r.report.features,
        r.report.iterations, r.report.times.total());
}

int SlamRun::end(const SessionOutcome& outcome, const std::vector<std::string>& findings)
{
    progress_.clear();
    second_pass_.clear();
    if (stream_) stream_->finish();
    if (options_.verbosity >= 1)
    {
        if (outcome.interrupted) std::fprintf(stderr, "interrupted: what was done is saved\n");
        std::cerr << warnings_.summaryOfRest();
    }
    if (options_.verbosity >= 2) printResults(outcome, findings);
    if (!outcome.failure.empty())
        throw std::runtime_error(outcome.failure + "; what was done before is saved");
    if (outcome.poses == 0) throw std::runtime_error("no scan could be used");
    if (outcome.pictures_failed || outcome.report_failed) return 1;
    return outcome.partly ? 3 : 0;
}

void SlamRun::printResults(const SessionOutcome& o, const std::vector<std::string>& findings) const
{
    const bool pictures = session_.pictures && o.poses > 0 && !o.pictures_failed;
    const bool page = session_.report && !o.report_failed;
    std::ostream& out = stream_ ? std::cerr : std::cout;  // the standard output is the stream's
    for (const std::string& finding : findings) out << finding << "\n";
    out << format(
        "%d poses, %.2f m, %.1f s of recording in %.1f s (%.1f ms a scan), %zu map points\n",
        o.poses, o.length, o.duration, o.wall_seconds, o.milliseconds_a_scan, o.map_points);
    if (o.live) out << linesOf(*o.live);
    out << format(
        "%zu submaps, %zu loops%s\n"
        "results in %s: trajectory.tum, map.ply, %smap.ot, map.bt, %s%smetrics.json\n",
        o.submaps, o.loops,
        o.undistorted_again ? " closed, every point undistorted again"
        : o.corrected       ? " closed"
        : o.loops > 0       ? " seen; the odometry has no gap to close"
                            : "",
        options_.output.c_str(), session_.method.map_export.las ? "map.las, " : "",
        pictures ? "snapshot_*.png, " : "", page ? "report.html, " : "");
}
}  // namespace taut
