/** taut-simulate: writes a rawlog with its truth from a scenario.
 * Exit codes: 0 done, 1 failed, 2 bad usage. */
#include <chrono>
#include <fstream>
#include <iostream>
#include <optional>
#include <thread>

#include "CommandLine.h"
#include "taut/rawlog/RawlogWriter.h"
#include "taut/simulation/Simulator.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace
{
using namespace taut;

struct Options
{
    std::string scenario, output;
    std::vector<std::string> settings;
    int threads = 1;
    bool quiet = false;
};

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd("Writes a rawlog with its truth from a scenario", ' ', "0.1");
    TCLAP::ValueArg<std::string> scenario(
        "c", "config", "Scenario (config/scenarios/*.yaml)", true, "", "FILE", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output",
        "Rawlog to write; beside it OUT.gt.tum (pose of the IMU in the world) and OUT.biases.csv",
        true, "", "OUT.rawlog", cmd);
    TCLAP::ValueArg<int> seed("", "seed", "Of motion and noise", false, 0, "N", cmd);
    TCLAP::ValueArg<double> duration(
        "", "duration", "Of the recording, with the rest at its start", false, 0, "S", cmd);
    TCLAP::MultiArg<std::string> set(
        "", "set", "Overrides a key of the scenario, as imu.rate=100", false, "KEY=VALUE", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "0 = as many as there are cores", false, 0, "N", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "No progress", cmd);
    if (!parseCommandLine(cmd, argc, argv)) return {};

    Options options;
    options.scenario = scenario.getValue();
    options.output = output.getValue();
    options.settings = set.getValue();
    if (seed.isSet()) options.settings.push_back("seed=" + std::to_string(seed.getValue()));
    if (duration.isSet())
        options.settings.push_back("duration=" + std::to_string(duration.getValue()));
    if (threads.getValue() < 0) throw UsageError("--threads is negative");
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    options.threads = threads.getValue() > 0 ? threads.getValue() : cores;
    options.quiet = quiet.getValue();
    return options;
}

std::string besides(const std::string& rawlog, const std::string& ending)
{
    const auto dot = rawlog.rfind(".rawlog");
    const bool has_ending = dot != std::string::npos && dot + 7 == rawlog.size();
    return (has_ending ? rawlog.substr(0, dot) : rawlog) + ending;
}

void writeTruth(const simulation::Simulator& simulator, Time start, const std::string& rawlog)
{
    TumWriter tum(besides(rawlog, ".gt.tum"));
    std::ofstream biases(besides(rawlog, ".biases.csv"));
    biases << "t,bias_gyro_x,bias_gyro_y,bias_gyro_z,bias_accel_x,bias_accel_y,bias_accel_z\n";
    const simulation::ImuRecording& imu = simulator.imu();
    for (std::size_t i = 0; i < imu.times.size(); i++)
    {
        const Time t = start + imu.times[i];
        tum.write({t, simulator.motion().poseAt(toSeconds(imu.times[i]))});
        biases << formatSeconds(t);
        for (const Vector3d& bias : {imu.gyro_bias[i], imu.accel_bias[i]})
            for (int axis = 0; axis < 3; axis++) biases << "," << bias[axis];
        biases << "\n";
    }
    tum.close();
    biases.close();
    if (!biases) throw std::runtime_error("cannot write " + besides(rawlog, ".biases.csv"));
}

void writeRawlog(
    const simulation::Simulator& simulator, Time start, const Options& options, Executor& executor)
{
    RawlogWriter rawlog(options.output);
    const ImuSamples& samples = simulator.imu().samples;
    std::size_t next = 0;
    const auto writeImuUntil = [&](Time end)
    {
        for (; next < samples.size() && samples[next].t < end; next++)
        {
            ImuSample sample = samples[next];
            sample.t += start;
            rawlog.write(sample);
        }
    };
    std::size_t points = 0;
    for (int k = 0; k < simulator.sweeps(); k++)
    {
        simulation::SimulatedScan simulated = simulator.sweep(k, executor);
        Scan& scan = simulated.scan;
        writeImuUntil(scan.end);  // in the order of arrival: a scan is there when it has ended
        scan.stamp += start;
        scan.end += start;
        points += scan.points.size();
        rawlog.write(scan);
        if (!options.quiet && (k + 1) % 20 == 0)
            std::cerr << "\rscan " << k + 1 << " of " << simulator.sweeps() << std::flush;
    }
    writeImuUntil(std::numeric_limits<Time>::max());
    rawlog.close();
    if (!options.quiet)
        std::cerr << "\r" << simulator.sweeps() << " scans, " << points << " points, " << next
                  << " IMU samples\n";
}

void run(const Options& options)
{
    ConfigSection section = simulation::loadScenarioFile(options.scenario, options.settings);
    const simulation::Scenario scenario = simulation::readScenario(section);
    const Time start = fromSeconds(scenario.start_time);
    const simulation::Simulator simulator(scenario);
    const auto peaks = simulation::peaksOf(simulator.motion());
    if (!options.quiet)
        std::cerr << "motion: up to " << peaks.speed << " m/s, " << peaks.acceleration << " m/s^2, "
                  << peaks.rate << " rad/s, " << peaks.angular_acceleration << " rad/s^2\n";
    Executor executor(options.threads);
    writeRawlog(simulator, start, options, executor);
    writeTruth(simulator, start, options.output);
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-simulate",
        [&]
        {
            if (const auto options = parse(argc, argv)) run(*options);
        });
}
