/** taut-calibrate: finds the errors of a LiDAR's beams from a recording.
 * Exit codes: 0 done, 1 failed, 2 bad usage. */
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "LogArguments.h"
#include "Progress.h"
#include "Signals.h"
#include "methodFile.h"
#include "taut/calibration/BeamCalibrator.h"
#include "taut/core/ImuUnits.h"
#include "taut/core/TimeText.h"
#include "taut/core/WarningLog.h"
#include "taut/core/format.h"
#include "taut/odometry/Pipeline.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Method.h"
#include "taut/session/registerSession.h"

namespace
{
struct Options
{
    taut::RawlogConfig log;
    taut::YamlNode rig;  // as given
    std::string output, config;
    std::vector<std::string> settings;
    int passes = 3, threads = 1;
    bool overwrite = false, quiet = false;
};

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-calibrate: finds how far each beam of a LiDAR is off its nominal elevation and "
        "range, from how its points lie to surfaces that other beams see. Writes a rig file for "
        "taut-slam -r. The recording should show floor, walls and, if there is one, a ceiling from "
        "many places. Exit codes: 0 done, 1 failed, 2 bad usage.",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> input(
        "recording", "Recording of a LiDAR with rings, and an IMU", true, "", "RECORDING", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output", "Rig file to write: that of -r with the beams", true, "", "RIG.yaml", cmd);
    taut::LogArguments part(cmd);
    TCLAP::ValueArg<std::string> config(
        "c", "config", "Method file (default: config/default.yaml)", false, "", "METHOD.yaml", cmd);
    TCLAP::MultiArg<std::string> set(
        "s", "set", "Override a key of the method file", false, "SECTION.KEY=VALUE", cmd);
    TCLAP::ValueArg<int> passes(
        "", "passes", "Times that the recording is gone through (default 3)", false, 3, "N", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "Threads (0: all processors); the result is the same", false, 0, "N", cmd);
    TCLAP::SwitchArg overwrite("w", "overwrite", "Write over a file that is there", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "Errors only", cmd);
    if (!taut::parseCommandLine(
            cmd, argc, argv, {{"LOG.rawlog -o rig.yaml", "LOG.rawlog -r rig.yaml -o better.yaml"}}))
        return {};
    Options o;
    o.log = part.log(input.getValue());
    if (!part.rig().empty()) o.rig = taut::readYamlFile(part.rig());
    o.output = output.getValue();
    o.config = config.getValue();
    o.settings = set.getValue();
    o.passes = passes.getValue();
    o.threads = taut::threadsOf(threads.getValue());
    o.overwrite = overwrite.getValue();
    o.quiet = quiet.getValue();
    if (o.passes < 1 || o.passes > 20) throw taut::UsageError("--passes must be 1 to 20");
    if (std::filesystem::exists(o.output) && !o.overwrite)
        throw taut::UsageError("'" + o.output + "' is there already; -w overwrites it");
    return o;
}

struct Pass
{
    std::vector<taut::CalibratedBeam> beams;
    double before = 0, after = 0;  // [m] thickness of planes
};

/** Runs the odometry once, and finds what is left of the beams' errors. */
Pass calibrateOnce(
    const Options& o, const taut::OdometryConfig& odometry, taut::Executor& executor,
    taut::Progress& progress, const taut::WarningSink& warn)
{
    std::optional<taut::BeamCalibrator> calibrator;
    taut::PrefetchedRawlog log(o.log, warn);
    int scans = 0;
    const auto take = [&](const taut::Event& event)
    {
        const auto* refined = std::get_if<taut::Refined>(&event);
        if (refined == nullptr) return;
        const taut::Scan& scan = refined->sweep.scan;
        if (scan.rings < 2)
            throw std::runtime_error("the LiDAR has no rings: its beams cannot be told apart");
        if (!calibrator)
            calibrator.emplace(taut::BeamCalibrationConfig(), scan.rings, o.log.rig.lidar.beams);
        calibrator->add(refined->sweep, refined->state);
        scans++;
    };
    taut::Pipeline pipeline(odometry, executor, warn, take);
    taut::Time first = 0, now = 0;
    while (auto measurement = log.next())
    {
        if (taut::interruption()) throw std::runtime_error("interrupted");
        if (auto* sample = std::get_if<taut::ImuSample>(&*measurement))
            pipeline.add(*sample);
        else
            pipeline.add(std::move(std::get<taut::Scan>(*measurement)));
        first = log.progress().first;
        now = log.progress().now;
        progress.update(log.progress().fraction(), scans, taut::toSeconds(now - first));
    }
    pipeline.finish();
    progress.clear();
    if (!calibrator) throw std::runtime_error("no scan could be used");
    Pass pass;
    pass.beams = calibrator->finish();
    pass.before = calibrator->thicknessBefore();
    pass.after = calibrator->thicknessAfter();
    return pass;
}

void print(const std::vector<taut::CalibratedBeam>& beams)
{
    std::printf("ring   elevation [deg]       range [mm]\n");
    for (std::size_t r = 0; r < beams.size(); r++)
    {
        const taut::CalibratedBeam& b = beams[r];
        std::printf(
            "%4zu   %+.4f +- %.4f%s   %+6.1f +- %.1f%s\n", r, b.elevation / taut::kDegree,
            b.elevation_sigma / taut::kDegree, b.elevation_shown ? " " : "?", 1000 * b.range,
            1000 * b.range_sigma, b.range_shown ? "" : " ?");
    }
    std::printf(
        "?: hardly shown. Elevations need floor, ceiling or slopes; ranges need walls, seen by "
        "several beams from near and far.\n");
}

void write(const Options& o)
{
    taut::YamlNode rig = o.rig;
    taut::YamlNode& beams = rig.section("lidar.beams");
    const auto put = [&](const std::string& key, const std::vector<double>& values, double unit)
    {
        beams.set(key, "");
        for (taut::YamlNode::Entry& entry : beams.map)
        {
            if (entry.key != key) continue;
            entry.value = {};
            entry.value.kind = taut::YamlNode::Kind::List;
            for (const double v : values)
                entry.value.list.emplace_back(taut::format("%.6g", v / unit));
        }
    };
    put("elevation", o.log.rig.lidar.beams.elevation, taut::kDegree);
    put("range", o.log.rig.lidar.beams.range, 1);
    const std::string part = o.output + ".part";
    std::ofstream file(part);
    file << "# Written by taut-calibrate. Elevations are in degrees, ranges in metres.\n"
         << taut::yamlText(rig);
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + o.output + "'");
    std::filesystem::rename(part, o.output);
}

void run(Options o)
{
    taut::catchSignals();
    taut::registerSession();
    taut::registerRenderers();
    taut::ConfigSection root = taut::readMethodFile(taut::findMethodFile(o.config), o.settings);
    const taut::Method method = taut::Method::read(root, o.log.rig.imu.noise);
    taut::Executor executor(o.threads);
    taut::Progress progress(!o.quiet);
    taut::WarningLog warnings(
        [&](const taut::Warning& w)
        {
            progress.clear();
            if (!o.quiet)
                std::fprintf(
                    stderr, "warning [%s] at %s s: %s\n", w.kind.c_str(),
                    taut::formatSeconds(w.t).c_str(), w.text.c_str());
        });
    Pass pass;
    for (int i = 0; i < o.passes; i++)
    {
        // All passes read the same: the first tells what is wrong.
        pass = calibrateOnce(
            o, method.odometry, executor, progress, i == 0 ? warnings.sink() : taut::WarningSink());
        taut::BeamCorrections& beams = o.log.rig.lidar.beams;
        beams = {};
        for (const taut::CalibratedBeam& b : pass.beams)
        {
            beams.elevation.push_back(b.elevation);
            beams.range.push_back(b.range);
        }
        if (!o.quiet)
            std::printf(
                "pass %d: planes are %.1f mm thick, %.1f mm with what was found\n", i + 1,
                1000 * pass.before, 1000 * pass.after);
    }
    write(o);
    if (!o.quiet) print(pass.beams);
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-calibrate",
        [&]
        {
            if (auto options = parse(argc, argv)) run(std::move(*options));
        });
}
