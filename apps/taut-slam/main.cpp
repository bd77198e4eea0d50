#include <mrpt/system/os.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "../CommandLine.h"
#include "../Progress.h"
#include "../Signals.h"
#include "../methodFile.h"
#include "Options.h"
#include "taut/core/Plugins.h"
#include "taut/inspection/Inspection.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/ResultFolder.h"
#include "taut/session/Session.h"
#include "taut/session/registerSession.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
const std::atomic<bool>& interrupted = interruption();

void loadPlugins(const std::vector<std::string>& plugins)
{
    for (const std::string& plugin : plugins)
    {
        std::string error;
        if (!mrpt::system::loadPluginModule(plugin, error))
            throw ConfigError("plug-in '" + plugin + "' cannot be loaded: " + error);
    }
}

KnownMap knownMap(const Options& o)
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

void makeFolder(const Options& o)
{
    if (!o.map.empty() && fs::exists(o.output) && fs::equivalent(o.map, o.output))
        throw UsageError("-o is the folder of -m: the map would be overwritten");
    if (fs::is_directory(o.log.path) && fs::exists(o.output) &&
        fs::equivalent(o.log.path, o.output))
        throw UsageError("the results would be mixed with the recording: choose another folder");
    try
    {
        prepareResultFolder(o.output, o.overwrite, {o.log.path, o.config, o.rig, o.truth});
    }
    catch (const FolderInUse& e)
    {
        throw UsageError(e.what());
    }
}

/** One run of the program: from a recording to a folder of results. */
class Run
{
 public:
    explicit Run(const Options& options)
        : options_(options),
          progress_(options.verbosity >= 2),
          second_pass_(options.verbosity >= 2),
          warnings_([this](const Warning& w) { print(w); })
    {
        if (!options.rig.empty()) session_.rig = readTextFile(options.rig);
        session_.method_file = findMethodFile(options.config);
        ConfigSection root = readMethodFile(session_.method_file, options.settings);
        session_.method = Method::read(root, options.log.rig.imu.noise);
        session_.folder = options.output;
        session_.input = options.log.path;
        session_.threads = options.threads;
        if (!options.map.empty()) session_.known_map = knownMap(options);
        session_.pictures = !options.no_pictures;
        session_.report = !options.no_report;
        if (!options.truth.empty()) session_.truth = readTum(options.truth, warnings_.sink());
    }

    /** The exit code. */
    int execute()
    {
        if (options_.show_config)
        {
            std::cout << session_.method.effective;
            return 0;
        }
        if (session_.known_map && !session_.method.slam.loops)
            throw UsageError("-m needs loops: slam.loops is false");
        PrefetchedRawlog log(options_.log, warnings_.sink());
        makeFolder(options_);
        if (!log.progress().pose_told && log.progress().has_imu) checkPose();
        Session session(session_, warnings_, [this](const Event& e) { describe(e); });
        const SessionOutcome outcome = session.run(
            log,
            [&](double share)
            {
                if (session.inSecondPass())
                    second_pass_.update(share);
                else
                    progress_.update(share, session.scans(), session.duration());
                return !interrupted;
            },
            [&] { return std::make_unique<PrefetchedRawlog>(options_.log); });
        progress_.clear();
        second_pass_.clear();
        report(outcome, log.progress().findings);
        if (!outcome.failure.empty())
            throw std::runtime_error(outcome.failure + "; what was done before is saved");
        if (outcome.poses == 0) throw std::runtime_error("no scan could be used");
        if (outcome.pictures_failed || outcome.report_failed) return 1;
        return outcome.partly ? 3 : 0;
    }

 private:
    /** Nothing tells the pose of the LiDAR: whether the identity fits, by the begin of the
     * recording. */
    void checkPose()
    {
        constexpr double kLooked = 60;  // [s]
        if (options_.verbosity >= 2)
            std::fprintf(
                stderr,
                "the recording does not tell the pose of its LiDAR: checking the identity\n");
        InspectionConfig config;
        config.log = options_.log;
        config.log.only_first_n = 0;
        config.log.to_time = std::min(config.log.to_time, config.log.from_time + kLooked);
        Executor executor(options_.threads);
        Findings findings;
        try
        {
            findings = inspectRecording(config, executor).findings;
        }
        catch (const std::exception&)
        {
            // Nothing can be read there: the run itself tells it.
        }
        for (const Finding& finding : findings)
            if (finding.kind == "extrinsic_rotation")
                warnings_.add(
                    {finding.t, finding.kind,
                     "nothing tells the pose of the LiDAR on the IMU, and it is not the "
                     "identity: " +
                         finding.text + "; " + finding.advice});
    }

    void print(const Warning& w)
    {
        if (options_.verbosity < 1) return;
        progress_.clear();
        std::fprintf(
            stderr, "warning [%s] at %s s: %s\n", w.kind.c_str(), formatSeconds(w.t).c_str(),
            w.text.c_str());
    }

    void describe(const Event& event)
    {
        const auto* estimated = std::get_if<Estimated>(&event);
        if (options_.verbosity < 3 || estimated == nullptr) return;
        const ScanResult& r = estimated->result;
        progress_.clear();
        std::fprintf(
            stderr, "%s: %d of %d features matched, %d iterations, %.1f ms\n",
            formatSeconds(r.estimate.state.t).c_str(), r.report.correspondences, r.report.features,
            r.report.iterations, r.report.times.total());
    }

    /** `findings`: about the recording, if it had to be imported. */
    void report(const SessionOutcome& o, const std::vector<std::string>& findings) const
    {
        if (options_.verbosity < 1) return;
        if (o.interrupted) std::fprintf(stderr, "interrupted: what was done is saved\n");
        std::cerr << warnings_.summaryOfRest();
        if (options_.verbosity < 2) return;
        for (const std::string& finding : findings) std::printf("%s\n", finding.c_str());
        const bool pictures = session_.pictures && o.poses > 0 && !o.pictures_failed;
        const bool page = session_.report && !o.report_failed;
        std::printf(
            "%d poses, %.2f m, %.1f s of recording in %.1f s (%.1f ms a scan), %zu map points\n"
            "%zu submaps, %zu loops%s\n"
            "results in %s: trajectory.tum, map.ply, map.ot, map.bt, %s%smetrics.json\n",
            o.poses, o.length, o.duration, o.wall_seconds, o.milliseconds_a_scan, o.map_points,
            o.submaps, o.loops,
            o.undistorted_again ? " closed, every point undistorted again"
            : o.corrected       ? " closed"
            : o.loops > 0       ? " seen; the odometry has no gap to close"
                                : "",
            options_.output.c_str(), pictures ? "snapshot_*.png, " : "",
            page ? "report.html, " : "");
    }

    const Options& options_;
    SessionConfig session_;
    Progress progress_, second_pass_;
    WarningLog warnings_;
};

int run(int argc, char** argv)
{
    Options options;
    if (!parseOptions(argc, argv, options)) return 0;
    catchSignals();
    registerSession();
    registerRenderers();
    loadPlugins(options.plugins);
    return Run(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-slam", [&] { return taut::run(argc, argv); }, {argv, argv + argc});
}
