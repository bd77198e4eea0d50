#include "taut/session/ResultFolder.h"

#include <filesystem>
#include <fstream>

#include "DiskReserve.h"
#include "taut/files/sameFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
constexpr const char* kMarker = ".taut-results";
constexpr const char* kResults[] = {
    "trajectory.tum",
    "trajectory_kitti.txt",
    "trajectory_odometry.tum",
    "states.csv",
    "timing.csv",
    "undistorted.points",
    "map.ply",
    "map.las",
    "map_moved.ply",
    "map.ot",
    "map.bt",
    "map.simplemap",
    "graph.g2o",
    "loops.csv",
    "metrics.json",
    "config.yaml",
    "rig.yaml",
    "report.html",
    ".taut-reserve",
    "snapshot_top.png",
    "snapshot_oblique.png",
    "snapshot_follow.png"};

/** Of a merge: one for each run. */
bool isTrajectoryOfRun(const fs::path& path)
{
    const std::string stem = path.stem().string(), begin = "trajectory_";
    return path.extension() == ".tum" && stem.size() > begin.size() && stem.rfind(begin, 0) == 0 &&
           stem.find_first_not_of("0123456789", begin.size()) == std::string::npos;
}

bool isThere(const fs::path& path)
{
    return fs::exists(fs::symlink_status(path));  // a link that leads nowhere too
}

bool isSubmapFile(const fs::path& path)
{
    const std::string stem = path.stem().string();
    return (path.extension() == ".tsm" || path.extension() == ".ply") && !stem.empty() &&
           stem.find_first_not_of("0123456789") == std::string::npos;
}

void refuseInputs(const fs::path& folder, const std::vector<std::string>& inputs)
{
    for (const char* name : kResults)
        if (const auto input = sameFile((folder / name).string(), inputs))
            throw FolderInUse(
                "the results would overwrite '" + *input +
                "', which is read: choose another folder");
}

/** Whether taut's results are in the folder. Before there was a marker, metrics.json told. */
bool isMarked(const fs::path& folder)
{
    if (isThere(folder / kMarker)) return true;
    std::ifstream metrics(folder / "metrics.json");
    std::string text(400, '\0');
    metrics.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text.find("\"taut-slam\"") != std::string::npos;
}

void removeSubmaps(const fs::path& folder)
{
    if (!fs::is_directory(fs::symlink_status(folder / "submaps"))) return;
    for (const auto& entry : fs::directory_iterator(folder / "submaps"))
        if (isSubmapFile(entry.path())) fs::remove(entry.path());
}
}  // namespace

void removeLoopResults(const std::string& folder)
{
    for (const char* name : {"trajectory_odometry.tum", "graph.g2o", "loops.csv", "map.simplemap"})
        fs::remove(fs::path(folder) / name);
    removeSubmaps(folder);
}

void prepareResultFolder(
    const std::string& folder_name, bool overwrite, const std::vector<std::string>& inputs)
{
    const fs::path folder = folder_name;
    if (fs::exists(folder) && !fs::is_directory(folder))
        throw std::runtime_error("'" + folder_name + "' is not a folder");
    refuseInputs(folder, inputs);
    if (DiskReserve::isTaken(folder))
        throw FolderInUse("another program writes its results to '" + folder_name + "' now");
    for (const char* name : kResults)
    {
        if (!isThere(folder / name)) continue;
        if (!isMarked(folder))
            throw FolderInUse(
                "'" + folder_name + "' holds a file '" + name +
                "' that taut did not write: choose another folder");
        if (!overwrite)
            throw FolderInUse("'" + folder_name + "' holds results already; -w overwrites them");
    }
    fs::create_directories(folder);
    if (isMarked(folder))
    {
        for (const char* name : kResults) fs::remove(folder / name);
        for (const auto& entry : fs::directory_iterator(folder))
            if (isTrajectoryOfRun(entry.path())) fs::remove(entry.path());
        removeSubmaps(folder);
    }
    std::ofstream marker(folder / kMarker);
    marker << "Results of taut, which -w removes.\n";
    if (!marker) throw std::runtime_error("cannot write to '" + folder_name + "'");
}
}  // namespace taut
