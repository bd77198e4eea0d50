/** taut-report: makes the page of a run from the folder of its results.
 * Exit codes: 0 done, 1 failed, 2 bad usage. */
#include <filesystem>
#include <iostream>
#include <optional>

#include "CommandLine.h"
#include "taut/report/writeReport.h"
#include "taut/session/RunReport.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace
{
struct Options
{
    std::filesystem::path folder, output;
    std::string truth;
};

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-report: makes a page of a run, one file for a browser with the map, the trajectory "
        "and plots. Exit codes: 0 done, 1 failed, 2 bad usage.",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> folder(
        "results", "Folder with the results of taut-slam", true, "", "OUT/", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output", "The page (default: report.html in the folder)", false, "", "PAGE.html",
        cmd);
    TCLAP::ValueArg<std::string> truth(
        "", "truth", "True trajectory (TUM file) to compare the run with", false, "", "GT.tum",
        cmd);
    const taut::Usage usage{{"out/hall_fast", "out/hall_fast --truth rawlogs/hall_fast.gt.tum"}};
    if (!taut::parseCommandLine(cmd, argc, argv, usage)) return {};

    Options options;
    options.folder = folder.getValue();
    options.output =
        output.isSet() ? std::filesystem::path(output.getValue()) : options.folder / "report.html";
    options.truth = truth.getValue();
    return options;
}

void run(const Options& options)
{
    const auto warn = [](const taut::Warning& w) { std::cerr << "warning: " << w.text << "\n"; };
    taut::Trajectory truth;
    if (!options.truth.empty()) truth = taut::readTum(options.truth, warn);
    taut::writeReport(
        taut::readRunReport(options.folder.string(), truth, warn), options.output.string());
    std::cout << options.output.string() << "\n";
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-report",
        [&]
        {
            if (const auto options = parse(argc, argv)) run(*options);
        });
}
