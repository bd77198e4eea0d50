/** taut-simulate: writes a rawlog with its truth from a scenario.
 * Exit codes: 0 done, 1 failed, 2 bad usage, 3 interrupted: what was done is saved. */
#include <fstream>
#include <iostream>
#include <optional>
#include <thread>

#include "../CommandLine.h"
#include "../Progress.h"
#include "../Signals.h"
#include "../guardOutput.h"
#include "Recorder.h"
#include "taut/files/MeshFile.h"
#include "taut/rawlog/RawlogSource.h"

namespace
{
struct Options
{
    std::string scenario;
    std::vector<std::string> settings;
    taut::RecorderConfig recorder;
    int threads = 1;
    bool quiet = false;
};

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-simulate: writes a rawlog with its truth from a scenario. Exit codes: 0 done, "
        "1 failed, 2 bad usage, 3 interrupted: what was done is saved.",
        ' ', TAUT_VERSION);
    TCLAP::ValueArg<std::string> scenario(
        "c", "config", "Scenario, as those in config/scenarios", true, "", "SCENARIO.yaml", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output",
        "Rawlog to write; beside it OUT.gt.tum (pose of the IMU in the world) and OUT.biases.csv. "
        "An older recording is replaced, nothing else is",
        true, "", "OUT.rawlog", cmd);
    TCLAP::ValueArg<int> seed("", "seed", "Of motion and noise", false, 0, "N", cmd);
    TCLAP::ValueArg<double> duration(
        "", "duration", "Of the recording, with the rest at its start", false, 0, "S", cmd);
    TCLAP::MultiArg<std::string> set(
        "", "set", "Overrides a key of the scenario, as in imu.rate=100", false, "KEY=VALUE", cmd);
    TCLAP::SwitchArg points("", "points", "Write OUT.points: the truth of every point", cmd);
    TCLAP::SwitchArg packets(
        "", "packets", "Write a VLP-16 or HDL-32E as raw packets instead of points", cmd);
    TCLAP::SwitchArg mesh(
        "", "mesh",
        "Write OUT.mesh.ply: the surface of all that is at rest, for taut-evaluate --map-truth",
        cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "0 (default): as many as there are cores", false, 0, "N", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "No progress", cmd);
    const taut::Usage usage{
        {"-c config/scenarios/hall_violent.yaml -o log.rawlog",
         "-c config/scenarios/hall_fast.yaml -o log.rawlog --seed 2 --duration 20"}};
    if (!taut::parseCommandLine(cmd, argc, argv, usage)) return {};

    Options options;
    options.scenario = scenario.getValue();
    options.settings = set.getValue();
    if (seed.isSet()) options.settings.push_back("seed=" + std::to_string(seed.getValue()));
    if (duration.isSet())
        options.settings.push_back("duration=" + std::to_string(duration.getValue()));
    options.recorder = {output.getValue(), points.getValue(), packets.getValue(), mesh.getValue()};
    if (threads.getValue() < 0) throw taut::UsageError("--threads is negative");
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    options.threads = threads.getValue() > 0 ? threads.getValue() : cores;
    options.quiet = quiet.getValue();
    return options;
}

std::vector<taut::simulation::RecordedPose> readRecording(
    const taut::simulation::MotionConfig& motion)
{
    std::vector<taut::simulation::RecordedPose> recording;
    if (motion.type == taut::simulation::MotionPreset::Replay)
        for (const taut::StampedPose& pose : taut::readTum(motion.replay.file))
            recording.push_back({pose.t, pose.T_world_imu});
    return recording;
}

bool beginsWith(const std::string& file, const std::string& text)
{
    std::string begin(text.size(), '\0');
    std::ifstream(file, std::ios::binary)
        .read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return begin == text;
}

/** An older recording is replaced; nothing else is, and nothing that is read. */
void guardOutputs(const Options& options, const taut::simulation::Scenario& scenario)
{
    const std::vector<std::string> inputs{
        options.scenario, scenario.motion.replay.file, scenario.world.file};
    const taut::RecordedFiles files = taut::recordedFiles(options.recorder.rawlog);
    const auto begins = [](const std::string& text)
    { return [text](const std::string& file) { return beginsWith(file, text); }; };
    taut::guardOutput(files.rawlog, inputs, taut::isRawlog);
    taut::guardOutput(files.truth, inputs, begins("# timestamp tx ty tz qx qy qz qw\n"));
    taut::guardOutput(files.biases, inputs, begins("t,bias_gyro_x,"));
    if (options.recorder.points) taut::guardOutput(files.points, inputs, begins("TAUTPNTS"));
    if (options.recorder.mesh)
        taut::guardOutput(files.mesh, inputs, begins(taut::meshFileStart(taut::kMeshComment)));
}

/** The exit code. */
int run(const Options& options)
{
    auto section = taut::simulation::loadScenarioFile(options.scenario, options.settings);
    const taut::simulation::Scenario scenario = taut::simulation::readScenario(section);
    guardOutputs(options, scenario);
    const taut::simulation::Simulator simulator(scenario, readRecording(scenario.motion));
    if (!options.quiet)
    {
        const auto peaks = taut::simulation::peaksOf(simulator.motion());
        std::cerr << "motion: up to " << peaks.speed << " m/s, " << peaks.acceleration << " m/s^2, "
                  << peaks.rate << " rad/s, " << peaks.angular_acceleration << " rad/s^2\n";
    }
    taut::Executor executor(options.threads);
    taut::Recorder recorder(options.recorder, scenario, simulator);
    {
        taut::Progress progress(!options.quiet);
        const int sweeps = simulator.sweeps();
        for (int k = 0; k < sweeps && !taut::interruption(); k++)
        {
            recorder.add(k, simulator.sweep(k, executor));
            const double done = (k + 1.0) / sweeps;
            progress.update(done, k + 1, done * scenario.duration);
        }
    }
    recorder.close();
    if (!options.quiet)
        std::cerr << recorder.points() << " points, " << recorder.samples() << " IMU samples\n";
    if (!taut::interruption()) return 0;
    std::cerr << "interrupted: what was done is saved\n";
    return 3;
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-simulate",
        [&]() -> int
        {
            try
            {
                const auto options = parse(argc, argv);
                if (!options) return 0;
                taut::catchSignals();
                return run(*options);
            }
            catch (const taut::ConfigError& e)
            {
                throw taut::UsageError(e.what());
            }
        });
}
