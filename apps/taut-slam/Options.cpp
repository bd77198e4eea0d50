#include "Options.h"

#include <filesystem>

#include "../LogArguments.h"

namespace taut
{
namespace
{
constexpr double kLongestWait = 1e6;  // [s]

/** From one of the two places where it may stand. */
std::string recordingOf(
    TCLAP::UnlabeledValueArg<std::string>& argument, TCLAP::ValueArg<std::string>& option,
    bool may_be_absent)
{
    if (argument.isSet() && option.isSet())
        throw UsageError("unexpected argument '" + argument.getValue() + "'");
    if (!argument.isSet() && !option.isSet() && !may_be_absent)
        throw UsageError("argument RECORDING is required");
    return argument.isSet() ? argument.getValue() : option.getValue();
}

/** "drive_taut" for "somewhere/drive.bag", here. */
std::string folderFor(const std::string& recording)
{
    namespace fs = std::filesystem;
    if (recording.empty()) return "";
    const fs::path path = fs::absolute(recording).lexically_normal();
    if (!path.has_filename()) return path.parent_path().filename().string() + "_taut";
    if (fs::is_directory(path)) return path.filename().string() + "_taut";
    const fs::path name = path.extension() == ".gz" ? path.stem() : path.filename();
    return name.stem().string() + "_taut";
}
}  // namespace

bool parseOptions(int argc, char** argv, Options& o)
{
    TCLAP::CmdLine cmd(
        "taut-slam: LiDAR-IMU SLAM that undistorts every point in every iteration. Reads a "
        "recording of a 3D LiDAR and an IMU (MRPT rawlog, ROS bag, packet capture, KITTI, folder "
        "of clouds); writes the trajectory, the map and pictures of both into a folder. Exit "
        "codes: 0 done, 1 failed, 2 bad usage, 3 done, but part of the log "
        "could not be used (the warnings and metrics.json say which and why).",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> recording(
        "recording",
        "The recording: rawlog (observations or sensory frames, gz or not), .bag, .mcap, .db3, "
        "capture, or folder",
        false, "", "RECORDING", cmd);
    TCLAP::ValueArg<std::string> input(
        "i", "input", "The recording, instead of the argument RECORDING", false, "", "RECORDING",
        cmd);
    SlamArguments common(cmd, FolderOption::Optional);
    LogArguments log(cmd);
    TCLAP::ValueArg<int> first(
        "", "only-first-n", "End after that many scans (0: all)", false, 0, "N", cmd);
    TCLAP::ValueArg<double> follow(
        "", "follow",
        "The rawlog is being written by another program: wait for more, until a signal comes or "
        "it has not grown for so long",
        false, 0, "SECONDS", cmd);
    TCLAP::ValueArg<std::string> truth(
        "", "truth", "True trajectory (TUM file) that report.html compares the run with", false, "",
        "GT.tum", cmd);
    TCLAP::SwitchArg show(
        "", "show-config", "Print the configuration in effect and end; needs no recording", cmd);
    const Usage usage{
        {"rawlogs/hall_fast.rawlog -o out/hall_fast", "drive.bag",
         "drive.mcap -o out/drive --lidar-topic /points --imu-topic /imu/data",
         "-i LOG.rawlog -o out/paper -c config/paper.yaml --threads 2",
         "-i TODAY.rawlog -o out/today -m out/yesterday",
         "-i TODAY.rawlog -o out/both -m out/yesterday --extend",
         "-i BEING_WRITTEN.rawlog -o out/now --follow 5 --stream"},
        &show,
        {&recording}};
    if (!parseCommandLine(cmd, argc, argv, usage)) return false;

    common.fill(o);
    o.show_config = show.getValue();
    const std::string path = recordingOf(recording, input, o.show_config);
    o.rig = log.rig();
    o.log = log.log(path);
    o.log.only_first_n = first.getValue();
    if (o.output.empty()) o.output = folderFor(path);
    o.follow = follow.getValue();
    if (follow.isSet() && !(o.follow > 0 && o.follow <= kLongestWait))
        throw UsageError("--follow: the seconds to wait must be above 0, and 1e6 at most");
    if (follow.isSet() && o.log.open) throw UsageError("--follow is for rawlogs alone");
    o.truth = truth.getValue();
    if (o.no_report && !o.truth.empty())
        throw UsageError("--truth is for report.html, which --no-report leaves out");
    if (o.log.only_first_n < 0) throw UsageError("--only-first-n must not be negative");
    return true;
}
}  // namespace taut
