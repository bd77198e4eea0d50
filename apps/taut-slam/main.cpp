#include <mrpt/core/exceptions.h>
#include <mrpt/system/os.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "../CommandLine.h"
#include "../Progress.h"
#include "MapExport.h"
#include "Metrics.h"
#include "Options.h"
#include "ResultFiles.h"
#include "methodFile.h"
#include "taut/core/Plugins.h"
#include "taut/core/Renderer.h"
#include "taut/odometry/Pipeline.h"
#include "taut/odometry/registerAll.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
std::atomic<bool> interrupted{false};
void onSignal(int)
{
    interrupted = true;
}

struct Method
{
    OdometryConfig odometry;
    MapExportConfig map_export;
    std::shared_ptr<Renderer> renderer;
    bool refined = true;
    std::string effective;  //!< YAML
};

Method readMethod(const Options& options, const std::string& path, const Rig& rig)
{
    ConfigSection root(readMethodFile(path, options.settings));
    Method m;
    m.odometry = OdometryConfig::read(root);
    if (rig.imu.noise)
    {
        m.odometry.imu_noise = *rig.imu.noise;
        m.odometry.imu_noise_from_rest = false;
    }
    ConfigSection& output = root.section("output");
    output.key("refined", m.refined, "write each pose as the next scan leaves it, one scan late");
    output.key(
        "undistorted_points", m.odometry.keep_undistorted,
        "write undistorted.points, for taut-evaluate --points");
    m.map_export.declare(output);
    m.renderer = createConfigured<Renderer>(root.section("render"), "taut::OSMesaRenderer");
    root.rejectUnknown();
    m.effective = root.effective();
    return m;
}

void loadPlugins(const std::vector<std::string>& plugins)
{
    for (const std::string& plugin : plugins)
    {
        std::string error;
        if (!mrpt::system::loadPluginModule(plugin, error))
            throw ConfigError("plug-in '" + plugin + "' cannot be loaded: " + error);
    }
}

RawlogConfig rawlogConfig(const Options& o, const Rig& rig)
{
    RawlogConfig c;
    c.path = o.input;
    c.lidar_label = o.lidar_label;
    c.imu_label = o.imu_label;
    c.from_time = o.from_time;
    c.to_time = o.to_time;
    c.only_first_n = o.only_first_n;
    c.rig = rig;
    return c;
}

void makeFolder(const Options& o)
{
    if (fs::exists(o.output) && !fs::is_directory(o.output))
        throw std::runtime_error("'" + o.output + "' is not a folder");
    if (fs::exists(fs::path(o.output) / "trajectory.tum") && !o.overwrite)
        throw UsageError("'" + o.output + "' holds results already; -w overwrites them");
    fs::create_directories(o.output);
}

void writeText(const fs::path& path, const std::string& text)
{
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + path.string() + "'");
}

/** One run of the program: from a rawlog to a folder of results. */
class Run
{
 public:
    explicit Run(const Options& options)
        : options_(options),
          rig_(options.rig.empty() ? Rig{} : loadRig(options.rig)),
          method_file_(findMethodFile(options.config)),
          method_(readMethod(options, method_file_, rig_)),
          progress_(options.verbosity >= 2),
          warnings_([this](const Warning& w) { print(w); })
    {
    }

    /** The exit code. */
    int execute()
    {
        if (options_.show_config)
        {
            std::cout << method_.effective;
            return 0;
        }
        PrefetchedRawlog log(rawlogConfig(options_, rig_), warnings_.sink());
        makeFolder(options_);
        writeText(fs::path(options_.output) / "config.yaml", method_.effective);
        MapExport map(method_.map_export, options_.output);
        ResultFiles files(options_.output, method_.refined, method_.odometry.keep_undistorted);

        const std::string failure = process(log, map, files);
        files.close();
        map.finish(warnings_.sink());
        const bool pictures = drawPictures(map, files);
        writeMetrics(log, map, files);
        report(files, map);
        if (!failure.empty()) throw std::runtime_error(failure + "; what was done before is saved");
        if (files.poses() == 0) throw std::runtime_error("no scan could be used");
        if (!pictures) return 1;
        const bool partly = log.incomplete() || log.progress().skipped > 0 || interrupted;
        return partly ? 3 : 0;
    }

 private:
    void print(const Warning& w)
    {
        if (options_.verbosity < 1) return;
        progress_.clear();
        std::fprintf(
            stderr, "warning [%s] at %s s: %s\n", w.kind.c_str(), formatSeconds(w.t).c_str(),
            w.text.c_str());
    }

    /** Empty, or what ended the processing early: the results up to there are kept. */
    std::string process(MeasurementStream& log, MapExport& map, ResultFiles& files)
    {
        const auto start = std::chrono::steady_clock::now();
        Executor executor(options_.threads);
        Pipeline pipeline(
            method_.odometry, executor, warnings_.sink(),
            [&](const Event& event)
            {
                const auto* estimated = std::get_if<Estimated>(&event);
                if (estimated == nullptr) return;
                const ScanResult& result = estimated->result;
                metrics_.add(result);
                files.add(result);
                map.add(result.estimate.state, result.points);
                if (options_.verbosity >= 3) describe(result);
            });
        std::string failure;
        try
        {
            while (!interrupted)
            {
                std::optional<Measurement> m = log.next();
                if (!m) break;
                if (auto* sample = std::get_if<ImuSample>(&*m))
                    pipeline.add(*sample);
                else
                    pipeline.add(std::move(std::get<Scan>(*m)));
                progress_.update(log.progress().fraction(), metrics_.scans(), metrics_.duration());
            }
            if (!interrupted) pipeline.finish();
        }
        catch (const std::exception& e)
        {
            failure = e.what();
        }
        progress_.clear();
        if (interrupted && options_.verbosity >= 1)
            std::fprintf(stderr, "interrupted: saving what was done\n");
        summary_.with_imu = pipeline.withImu();
        if (pipeline.initialization())
            summary_.rest_seconds = pipeline.initialization()->rest_duration;
        summary_.map_cells = pipeline.mapSize();
        summary_.wall_seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return failure;
    }

    void describe(const ScanResult& r)
    {
        progress_.clear();
        std::fprintf(
            stderr, "%s: %d of %d features matched, %d iterations, %.1f ms\n",
            formatSeconds(r.estimate.state.t).c_str(), r.correspondences, r.features, r.iterations,
            r.times.total());
    }

    std::vector<std::string> caption(const ResultFiles& files) const
    {
        char numbers[160];
        std::snprintf(
            numbers, sizeof numbers, "%.1f m, %.1f s, %d scans, undistortion: %s", files.length(),
            metrics_.duration(), files.poses(), nameOf(method_.odometry.estimation.undistortion));
        return {fs::path(options_.input).filename().string(), numbers};
    }

    bool drawPictures(const MapExport& map, const ResultFiles& files)
    {
        if (options_.no_pictures || files.poses() == 0) return true;
        try
        {
            const RenderScene scene{map.sample(), files.sample(), caption(files)};
            for (const View view : kAllViews)
                method_.renderer->render(
                    scene, view,
                    (fs::path(options_.output) / ("snapshot_" + std::string(nameOf(view)) + ".png"))
                        .string());
            return true;
        }
        catch (const std::exception& e)
        {
            warnings_.add({0, "no_pictures", e.what()});
            return false;
        }
    }

    void writeMetrics(const MeasurementStream& log, const MapExport& map, const ResultFiles& files)
    {
        summary_.log = log.progress();
        summary_.incomplete = log.incomplete();
        summary_.interrupted = interrupted;
        summary_.length = files.length();
        summary_.map_points = map.points();
        summary_.key_scans = map.keyScans();
        summary_.occupancy_resolution = map.occupancyResolution();
        summary_.mode = nameOf(method_.odometry.estimation.undistortion);
        summary_.method_file = method_file_;
        summary_.threads = options_.threads;
        writeText(fs::path(options_.output) / "metrics.json", metrics_.json(summary_, warnings_));
    }

    void report(const ResultFiles& files, const MapExport& map) const
    {
        if (options_.verbosity >= 1) std::cerr << warnings_.summaryOfRest();
        if (options_.verbosity < 2) return;
        std::printf(
            "%d poses, %.2f m, %.1f s of recording in %.1f s (%.1f ms a scan), %zu map points\n"
            "results in %s: trajectory.tum, map.ply, map.ot, map.bt, snapshot_*.png, "
            "metrics.json\n",
            files.poses(), files.length(), metrics_.duration(), summary_.wall_seconds,
            metrics_.meanMilliseconds(), map.points(), options_.output.c_str());
    }

    const Options& options_;
    Rig rig_;
    std::string method_file_;
    Method method_;
    Progress progress_;
    WarningLog warnings_;
    Metrics metrics_{options_.input};
    Metrics::Summary summary_;
};

int run(int argc, char** argv)
{
    Options options;
    if (!parseOptions(argc, argv, options)) return 0;
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    registerAll();
    registerRenderers();
    loadPlugins(options.plugins);
    return Run(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram("taut-slam", [&] { return taut::run(argc, argv); });
}
