#include "Options.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "../LogArguments.h"

namespace taut
{
namespace
{
int verbosityOf(const std::string& level)
{
    const std::map<std::string, int> levels{{"ERROR", 0}, {"WARN", 1}, {"INFO", 2}, {"DEBUG", 3}};
    const auto it = levels.find(level);
    if (it == levels.end())
        throw UsageError("-v: '" + level + "' is none of ERROR, WARN, INFO, DEBUG");
    return it->second;
}
/** "x,y,z,yaw" [m, degrees] to numbers [m, rad]. */
std::vector<double> startOf(const std::string& text)
{
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');)
    {
        std::size_t used = 0;
        double number = 0;
        try
        {
            number = std::stod(word, &used);
        }
        catch (const std::exception&)  // told below
        {
            used = 0;
        }
        if (used == 0 || used != word.size() || !std::isfinite(number))
            throw UsageError("--start-at: '" + word + "' is no number");
        numbers.push_back(number);
    }
    if (numbers.size() != 4)
        throw UsageError("--start-at: four numbers are wanted, x,y,z,yaw, in '" + text + "'");
    numbers[3] *= M_PI / 180;
    return numbers;
}
void requireMapFor(const Options& o, bool localize)
{
    if (localize && o.extend_map) throw UsageError("--localize and --extend exclude each other");
    if (o.map.empty() && (localize || o.extend_map || !o.start_at.empty()))
        throw UsageError("--localize, --extend and --start-at need a map: -m");
}

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
    TCLAP::ValueArg<std::string> output(
        "o", "output", "Folder for the results (default: named after the recording, with _taut)",
        false, "", "OUT/", cmd);
    TCLAP::ValueArg<std::string> config(
        "c", "config", "Method file: the choices of the method (default: config/default.yaml)",
        false, "", "METHOD.yaml", cmd);
    TCLAP::MultiArg<std::string> set(
        "s", "set", "Override a key of the method file, as estimation.undistortion=imu", false,
        "SECTION.KEY=VALUE", cmd);
    LogArguments log(cmd);
    TCLAP::ValueArg<std::string> map(
        "m", "map", "Results of an earlier run of this place: the run is told in its frame", false,
        "", "EARLIER/", cmd);
    TCLAP::SwitchArg localize("", "localize", "The map of -m stays as it is (default)", cmd);
    TCLAP::SwitchArg extend(
        "", "extend", "The map of -m and this run become one map in the folder of -o", cmd);
    TCLAP::ValueArg<std::string> start(
        "", "start-at",
        "Where the run begins in the map of -m, to a metre and ten degrees [m, degrees]", false, "",
        "X,Y,Z,YAW", cmd);
    TCLAP::ValueArg<int> first(
        "", "only-first-n", "End after that many scans (0: all)", false, 0, "N", cmd);
    TCLAP::MultiArg<std::string> plugins(
        "p", "plugin", "Shared library with further classes for the plug points", false,
        "PLUGIN.so", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "Threads of the estimation (0: all processors); the result is the same",
        false, 0, "N", cmd);
    TCLAP::SwitchArg overwrite("w", "overwrite", "Write into a folder that has results", cmd);
    TCLAP::SwitchArg pictures("", "no-pictures", "Do not render snapshots", cmd);
    TCLAP::SwitchArg no_report("", "no-report", "Do not write report.html", cmd);
    TCLAP::ValueArg<std::string> truth(
        "", "truth", "True trajectory (TUM file) that report.html compares the run with", false, "",
        "GT.tum", cmd);
    TCLAP::SwitchArg show(
        "", "show-config", "Print the configuration in effect and end; needs no recording", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "Errors only: as -v ERROR", cmd);
    TCLAP::ValueArg<std::string> level(
        "v", "verbosity", "How much is told (default INFO)", false, "INFO", "ERROR|WARN|INFO|DEBUG",
        cmd);
    const Usage usage{
        {"rawlogs/hall_fast.rawlog -o out/hall_fast", "drive.bag",
         "drive.mcap -o out/drive --lidar-topic /points --imu-topic /imu/data",
         "-i LOG.rawlog -o out/paper -c config/paper.yaml --threads 2",
         "-i TODAY.rawlog -o out/today -m out/yesterday",
         "-i TODAY.rawlog -o out/both -m out/yesterday --extend"},
        &show,
        {&recording}};
    if (!parseCommandLine(cmd, argc, argv, usage)) return false;

    o.show_config = show.getValue();
    const std::string path = recordingOf(recording, input, o.show_config);
    o.log = log.log(path);
    o.log.only_first_n = first.getValue();
    o.output = output.getValue().empty() ? folderFor(path) : output.getValue();
    o.config = config.getValue();
    o.settings = set.getValue();
    o.rig = log.rig();
    o.map = map.getValue();
    o.extend_map = extend.getValue();
    if (!start.getValue().empty()) o.start_at = startOf(start.getValue());
    requireMapFor(o, localize.getValue());
    o.plugins = plugins.getValue();
    o.threads = threadsOf(threads.getValue());
    o.overwrite = overwrite.getValue();
    o.no_pictures = pictures.getValue();
    o.no_report = no_report.getValue();
    o.truth = truth.getValue();
    if (o.no_report && !o.truth.empty())
        throw UsageError("--truth is for report.html, which --no-report leaves out");
    o.verbosity = quiet.getValue() ? 0 : verbosityOf(level.getValue());
    if (o.log.only_first_n < 0) throw UsageError("--only-first-n must not be negative");
    return true;
}
}  // namespace taut
