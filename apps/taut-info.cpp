/** taut-info: tells what a recording is like and what is wrong with it.
 * Exit codes: 0 nothing found, 1 failed, 2 bad usage, 3 findings. */
#include <iostream>
#include <optional>

#include "LogArguments.h"
#include "Progress.h"
#include "taut/inspection/InspectionReport.h"
#include "taut/odometry/registerAll.h"

namespace
{
struct Options
{
    taut::InspectionConfig inspection;
    int threads = 1;
    bool json = false, quiet = false;
};

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-info: a doctor for recordings. Tells the sensors, rates, units, rest and noise of a "
        "recording (whatever taut-slam reads), and what is wrong with it: gaps, stamps, clipped or "
        "damaged values, clocks that "
        "differ, an extrinsic rotation that does not fit. Each finding comes with its time, its "
        "value and what to do (docs/inspecting.md). Exit codes: 0 nothing found, 1 failed, 2 bad "
        "usage, 3 findings.",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> input(
        "recording",
        "The recording: rawlog (observations or sensory frames, gz or not), .bag, .mcap, .db3, "
        "capture, or folder",
        true, "", "RECORDING", cmd);
    taut::LogArguments part(cmd);
    TCLAP::ValueArg<double> window(
        "", "window",
        "Seconds, where the body turns most, whose scans are matched for clock offset and "
        "extrinsic rotation (default 20)",
        false, 20, "SECONDS", cmd);
    TCLAP::SwitchArg no_matching(
        "", "no-matching", "Do not match scans: quicker, without clock offset and extrinsic", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "Threads of the matching (0: all processors); the result is the same", false,
        0, "N", cmd);
    TCLAP::SwitchArg json("", "json", "Write JSON instead of text", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "No progress", cmd);
    const taut::Usage usage{
        {"rawlogs/hall_fast.rawlog", "LOG.rawlog --from-time 10 --json > report.json"}};
    if (!taut::parseCommandLine(cmd, argc, argv, usage)) return {};

    Options o;
    o.inspection.log = part.log(input.getValue());
    if (!(window.getValue() >= 3 && window.getValue() <= 600))
        throw taut::UsageError("--window must be 3 to 600 s");
    o.inspection.window = window.getValue();
    o.inspection.match_scans = !no_matching.getValue();
    o.threads = taut::threadsOf(threads.getValue());
    o.json = json.getValue();
    o.quiet = quiet.getValue();
    return o;
}

int run(const Options& options)
{
    taut::registerAll();
    taut::Executor executor(options.threads);
    taut::Progress progress(!options.quiet);
    const taut::Inspection inspection = taut::inspectRecording(
        options.inspection, executor,
        [&](double share, std::size_t scans, double seconds)
        { progress.update(share, static_cast<int>(scans), seconds); });
    progress.clear();
    std::cout
        << (options.json ? taut::inspectionAsJson(inspection) : taut::inspectionAsText(inspection));
    return inspection.findings.empty() ? 0 : 3;
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-info",
        [&]
        {
            const auto options = parse(argc, argv);
            return options ? run(*options) : 0;
        },
        {argv, argv + argc});
}
