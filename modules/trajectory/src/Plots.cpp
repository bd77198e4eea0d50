#include "taut/trajectory/Plots.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr const char* kScript = "plot.gp";

constexpr const char* kTrajectoryPlot = R"(
set size ratio -1
set xlabel 'x [m]'
set ylabel 'y [m]'
set cblabel 'position error [m]'
set cbrange [0:]
set key below
set palette defined (0 '#1f5fa8', 0.5 '#8e3d8e', 1 '#e0301f')
plot 'truth.dat' using 2:3 with lines lw 4 lc rgb '#c0c0c0' title 'truth', \
     'estimate.dat' using 2:3:5 with lines lw 1.5 lc palette title 'estimate', \
     'truth.dat' using 2:3 every ::0::0 with points pt 7 ps 0.8 lc rgb 'black' title 'start'
)";

constexpr const char* kErrorPlot = R"(
set xlabel 'time since the first true pose [s]'
set yrange [0:]
set key off
plot 'estimate.dat' using 1:%d with lines lw 1.5 lc rgb '#20608f'
)";

void requireWritten(std::ofstream& file, const std::string& path)
{
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + path + "'");
}

/** Columns t x y z [error_position error_rotation]; a blank line, which breaks the curve, at a gap.
 */
class DataFile
{
 public:
    DataFile(const std::filesystem::path& path, Time origin, Duration max_gap)
        : path_(path.string()), file_(path), origin_(origin), max_gap_(max_gap)
    {
        file_.precision(9);
    }
    void add(Time t, const Vector3d& p, const PoseError* error = nullptr)
    {
        if (any_ && t - last_ > max_gap_) file_ << '\n';
        any_ = true;
        last_ = t;
        file_ << toSeconds(t - origin_) << ' ' << p.x() << ' ' << p.y() << ' ' << p.z();
        if (error) file_ << ' ' << error->position << ' ' << error->rotation_deg;
        file_ << '\n';
    }
    void close() { requireWritten(file_, path_); }

 private:
    std::string path_;
    std::ofstream file_;
    Time origin_;
    Duration max_gap_;
    bool any_ = false;
    Time last_ = 0;
};

void writeData(const Scores& scores, const Trajectory& truth, const std::filesystem::path& folder)
{
    const Time origin = truth.front().t;
    DataFile truth_file(folder / "truth.dat", origin, 3 * medianSpacing(truth));
    for (const StampedPose& pose : truth) truth_file.add(pose.t, pose.T_world_imu.p);
    truth_file.close();

    Trajectory aligned;
    for (const PosePair& pair : scores.pairs)
        aligned.push_back({pair.t, scores.absolute.T_truth_estimate * pair.estimate});
    DataFile estimate_file(folder / "estimate.dat", origin, 3 * medianSpacing(aligned));
    for (std::size_t i = 0; i < aligned.size(); i++)
        estimate_file.add(aligned[i].t, aligned[i].T_world_imu.p, &scores.absolute.errors[i]);
    estimate_file.close();
}

std::string titleOf(const char* what, const Statistics& s, const char* unit)
{
    std::array<char, 160> text{};
    std::snprintf(
        text.data(), text.size(), "set title '%s: RMSE %.4g %s, largest %.4g %s'\n", what, s.rmse,
        unit, s.max, unit);
    return text.data();
}

std::string errorPlot(int column)
{
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), kErrorPlot, column);
    return text.data();
}

void writeScript(const Scores& scores, const std::filesystem::path& folder, PlotFormat format)
{
    const bool svg = format == PlotFormat::Svg;
    const auto output = [&](const char* name)
    { return std::string("set output '") + name + (svg ? ".svg" : ".png") + "'\n"; };
    const std::string path = (folder / kScript).string();
    std::ofstream file(path);
    file << "set terminal "
         << (svg ? "svg size 900,600 background 'white'" : "pngcairo size 900,600")
         << " enhanced font 'sans,12'\nset grid\n"
         << output("position_error") << titleOf("position error", scores.absolute.position, "m")
         << "set ylabel 'position error [m]'" << errorPlot(5) << output("rotation_error")
         << titleOf("rotation error", scores.absolute.rotation_deg, "deg")
         << "set ylabel 'rotation error [deg]'" << errorPlot(6) << "set autoscale y\n"
         << output("trajectory") << titleOf("trajectory from above", scores.absolute.position, "m")
         << kTrajectoryPlot;
    requireWritten(file, path);
}

/** Runs gnuplot inside the folder, without a shell. */
void runGnuplot(const std::filesystem::path& folder)
{
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::string program = "gnuplot", script = kScript;
    const std::array<char*, 3> arguments{program.data(), script.data(), nullptr};
    pid_t child = 0;
    const int error =
        posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT)
        throw std::runtime_error(
            "cannot draw: gnuplot is not installed (Debian: gnuplot-nox); data and script are in "
            "'" +
            folder.string() + "'");
    if (error != 0)
        throw std::runtime_error(std::string("cannot start gnuplot: ") + std::strerror(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw std::runtime_error("lost sight of gnuplot");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("gnuplot failed on '" + (folder / kScript).string() + "'");
}
}  // namespace

void plotScores(
    const Scores& scores, const Trajectory& truth, const std::string& folder, PlotFormat format)
{
    std::filesystem::create_directories(folder);
    writeData(scores, truth, folder);
    writeScript(scores, folder, format);
    runGnuplot(folder);
}
}  // namespace taut
