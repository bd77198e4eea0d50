/** taut-evaluate: scores an estimated trajectory and a map against the truth.
 * Exit codes: 0 scored, 1 failed or refused, 2 bad usage. */
#include <algorithm>
#include <initializer_list>
#include <iostream>
#include <optional>

#include "CommandLine.h"
#include "taut/core/WarningLog.h"
#include "taut/evaluation/Report.h"
#include "taut/slam/LoopScores.h"
#include "taut/trajectory/Interpolation.h"
#include "taut/trajectory/Plots.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace
{
struct Options
{
    std::string truth, estimate, kitti_times, points, points_truth, plot_folder, loops;
    std::string frame_truth, frame_estimate;
    taut::PlotFormat plot_format = taut::PlotFormat::Svg;
    bool json = false;
    double from_time = 0;  // [s] since the first true pose
    taut::ScoreOptions score;
    taut::MapOptions map;
    int threads = 1;
};

taut::Alignment alignmentOf(const std::string& name)
{
    try
    {
        return taut::alignmentOf(name);
    }
    catch (const std::invalid_argument& e)
    {
        throw taut::UsageError(e.what());
    }
}

const std::vector<double>& positive(const std::vector<double>& values)
{
    for (const double v : values)
        if (!(v > 0)) throw taut::UsageError("times and distances must be above zero");
    return values;
}

taut::PlotFormat plotFormatOf(const std::string& name)
{
    if (name == "svg") return taut::PlotFormat::Svg;
    if (name == "png") return taut::PlotFormat::Png;
    throw taut::UsageError("'" + name + "' is not a format of plots (svg, png)");
}

taut::MapOptions mapOptions(
    TCLAP::ValueArg<std::string>& map, TCLAP::ValueArg<std::string>& truth,
    TCLAP::ValueArg<double>& within, TCLAP::ValueArg<double>& reach)
{
    if (truth.isSet() && !map.isSet()) throw taut::UsageError("--map-truth needs --map");
    for (TCLAP::ValueArg<double>* arg : {&within, &reach})
    {
        if (!arg->isSet()) continue;
        if (!truth.isSet()) throw taut::UsageError("--" + arg->getName() + " needs --map-truth");
        if (!(arg->getValue() > 0))
            throw taut::UsageError("--" + arg->getName() + " must be above zero");
    }
    taut::MapOptions options;
    options.map = map.getValue();
    options.truth = truth.getValue();
    options.within = within.getValue();
    options.reach = reach.getValue();
    return options;
}

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-evaluate: scores an estimated trajectory and a map against the truth. Exit codes: 0 "
        "scored, 1 failed or refused, 2 bad usage.",
        ' ', TAUT_VERSION);
    TCLAP::ValueArg<std::string> truth(
        "", "truth", "True trajectory (TUM file, or EuRoC's data.csv)", true, "", "FILE", cmd);
    TCLAP::ValueArg<std::string> estimate(
        "", "estimate", "Estimated trajectory (TUM file)", true, "", "FILE", cmd);
    TCLAP::ValueArg<std::string> kitti_times(
        "", "kitti-times", "Both trajectories are KITTI poses, with these times", false, "", "FILE",
        cmd);
    TCLAP::SwitchArg json("", "json", "Write JSON instead of a table", cmd);
    TCLAP::ValueArg<std::string> alignment(
        "", "align",
        "Alignment of the estimate to the truth (default se3). A map takes that of its "
        "trajectory; without one, it is laid on --map-truth by point-to-plane ICP from the frame "
        "that it has (se3, yaw), or taken as it is (none)",
        false, "se3", "se3|yaw|none", cmd);
    TCLAP::ValueArg<std::string> frame_estimate(
        "", "frame-estimate",
        "Trajectory of another run in the same frame, such as the known map's: the alignment is "
        "taken from it",
        false, "", "FILE", cmd);
    TCLAP::ValueArg<std::string> frame_truth(
        "", "frame-truth", "The truth of --frame-estimate", false, "", "FILE", cmd);
    TCLAP::ValueArg<double> min_coverage(
        "", "min-coverage",
        "Share of the truth to be covered, else refused (default 0.5); of a map that is laid on "
        "its truth by ICP, share of its points within 0.5 m of it",
        false, 0.5, "0..1", cmd);
    TCLAP::ValueArg<int> min_poses(
        "", "min-poses", "Poses to be scored, else refused (default 10)", false, 10, "N", cmd);
    TCLAP::ValueArg<double> from_time(
        "", "from-time", "Leave out what is earlier: seconds since the first true pose", false, 0,
        "S", cmd);
    TCLAP::MultiArg<double> rpe_seconds(
        "", "rpe-seconds", "Relative error over that time [s] (default 1 and 10)", false, "S", cmd);
    TCLAP::MultiArg<double> rpe_metres(
        "", "rpe-metres", "Relative error over that distance [m] (default 1 and 10)", false, "M",
        cmd);
    TCLAP::ValueArg<std::string> points(
        "", "points", "Undistorted points of the estimate, to be scored too", false, "", "FILE",
        cmd);
    TCLAP::ValueArg<std::string> points_truth(
        "", "points-truth", "True undistorted points (of taut-simulate)", false, "", "FILE", cmd);
    TCLAP::ValueArg<std::string> loops(
        "", "loops", "Score the loops of that folder of results too: precision, recall, errors",
        false, "", "OUT/", cmd);
    TCLAP::ValueArg<std::string> map(
        "", "map",
        "Score that map too (PLY): thickness of its walls and mean map entropy; with --map-truth, "
        "distance and completeness. Needs no trajectories",
        false, "", "map.ply", cmd);
    TCLAP::ValueArg<std::string> map_truth(
        "", "map-truth",
        "True surface of the place: a mesh (PLY, OBJ; taut-simulate --mesh writes one) or a dense "
        "cloud (PLY)",
        false, "", "FILE", cmd);
    TCLAP::ValueArg<double> map_within(
        "", "map-within",
        "Distance for completeness [m] (default 0.05): the share of the truth that has a point of "
        "the map so near",
        false, taut::MapOptions().within, "M", cmd);
    TCLAP::ValueArg<double> map_reach(
        "", "map-reach",
        "Leave out points of the map that are further from the truth [m], as where it covers less "
        "(default: all count)",
        false, taut::MapOptions().reach, "M", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "For the map; 0 (default): as many as there are cores", false, 0, "N", cmd);
    TCLAP::ValueArg<std::string> plot(
        "", "plot", "Draw the trajectory and the errors into that folder (needs gnuplot)", false,
        "", "FOLDER", cmd);
    TCLAP::ValueArg<std::string> plot_format(
        "", "plot-format", "Format of the plots (default svg)", false, "svg", "svg|png", cmd);
    const taut::Usage usage{
        {"--truth rawlogs/hall_fast.gt.tum --estimate out/hall_fast/trajectory.tum",
         "--truth GT.tum --estimate trajectory.tum --align yaw --plot out/plots",
         "--map out/run/map.ply --map-truth log.mesh.ply --json"},
        &map};
    if (!taut::parseCommandLine(cmd, argc, argv, usage)) return {};

    Options options;
    options.truth = truth.getValue();
    options.estimate = estimate.getValue();
    if (options.truth.empty() != options.estimate.empty())
        throw taut::UsageError("--truth and --estimate need each other");
    options.kitti_times = kitti_times.getValue();
    options.json = json.getValue();
    options.score.alignment = alignmentOf(alignment.getValue());
    options.frame_truth = frame_truth.getValue();
    options.frame_estimate = frame_estimate.getValue();
    if (options.frame_truth.empty() != options.frame_estimate.empty())
        throw taut::UsageError("--frame-truth and --frame-estimate need each other");
    options.from_time = from_time.getValue();
    if (!(options.from_time >= 0)) throw taut::UsageError("--from-time is negative");
    options.score.min_coverage = min_coverage.getValue();
    if (rpe_seconds.isSet()) options.score.rpe_seconds = positive(rpe_seconds.getValue());
    if (rpe_metres.isSet()) options.score.rpe_metres = positive(rpe_metres.getValue());
    options.points = points.getValue();
    options.points_truth = points_truth.getValue();
    if (options.points.empty() != options.points_truth.empty())
        throw taut::UsageError("--points and --points-truth need each other");
    options.loops = loops.getValue();
    options.plot_folder = plot.getValue();
    for (const TCLAP::Arg* arg : std::initializer_list<const TCLAP::Arg*>{
             &kitti_times, &frame_truth, &points, &loops, &plot, &from_time})
        if (options.truth.empty() && arg->isSet())
            throw taut::UsageError("--" + arg->getName() + " needs --truth and --estimate");
    options.map = mapOptions(map, map_truth, map_within, map_reach);
    if (options.truth.empty() && options.map.map.empty())
        throw taut::UsageError("a file without a name");
    options.map.alignment = options.score.alignment;
    options.map.min_near = options.score.min_coverage;
    options.threads = taut::threadsOf(threads.getValue());
    options.plot_format = plotFormatOf(plot_format.getValue());
    if (min_poses.getValue() < 0) throw taut::UsageError("--min-poses is negative");
    options.score.min_poses = static_cast<std::size_t>(min_poses.getValue());
    return options;
}

taut::Trajectory since(taut::Time begin, taut::Trajectory trajectory)
{
    const auto first = std::find_if(
        trajectory.begin(), trajectory.end(),
        [begin](const taut::StampedPose& pose) { return pose.t >= begin; });
    trajectory.erase(trajectory.begin(), first);
    return trajectory;
}

/** The truth between its poses; nothing outside, or in a gap of a second. */
std::optional<taut::Pose> poseAt(const taut::Trajectory& truth, taut::Time t)
{
    const auto after = std::lower_bound(
        truth.begin(), truth.end(), t,
        [](const taut::StampedPose& pose, taut::Time at) { return pose.t < at; });
    if (after == truth.end()) return {};
    if (after->t == t) return after->T_world_imu;
    if (after == truth.begin()) return {};
    const taut::StampedPose& before = *(after - 1);
    const double gap = taut::toSeconds(after->t - before.t);
    if (gap > 1) return {};
    return taut::interpolate(
        before.T_world_imu, after->T_world_imu, taut::toSeconds(t - before.t) / gap);
}

taut::Trajectory readTrajectory(
    const std::string& path, const Options& options, const taut::WarningSink& warn)
{
    if (!options.kitti_times.empty()) return taut::readKitti(path, options.kitti_times);
    const bool csv = path.size() > 4 && path.compare(path.size() - 4, 4, ".csv") == 0;
    return csv ? taut::readEuroc(path, warn) : taut::readTum(path, warn);
}

/** Scores what has to do with trajectories, with the truth that they were scored against. */
taut::Trajectory scoreTrajectories(const Options& options, taut::Evaluation& evaluation)
{
    taut::WarningLog warnings([](const taut::Warning& w)
                              { std::cerr << "warning: " << w.text << "\n"; });
    const auto read = [&](const std::string& path)
    { return readTrajectory(path, options, warnings.sink()); };
    taut::Trajectory truth = read(options.truth), estimate = read(options.estimate);
    taut::Time begin = 0;
    if (options.from_time > 0 && !truth.empty())
    {
        begin = truth.front().t + taut::fromSeconds(options.from_time);
        truth = since(begin, std::move(truth));
        estimate = since(begin, std::move(estimate));
    }
    taut::ScoreOptions score = options.score;
    if (!options.frame_truth.empty())
    {
        score.T_truth_estimate = align(
            taut::pairPoses(read(options.frame_truth), read(options.frame_estimate)),
            score.alignment);
        score.alignment = taut::Alignment::Given;
    }
    evaluation.trajectory = scoreTrajectory(truth, estimate, score);
    std::cerr << warnings.summaryOfRest();
    if (!options.points.empty())
        evaluation.points = taut::scorePoints(
            options.points_truth, options.points, options.score.min_coverage, begin);
    if (!options.loops.empty())
        evaluation.loops =
            taut::scoreLoops(options.loops, [&](taut::Time t) { return poseAt(truth, t); });
    return truth;
}

void run(const Options& options)
{
    taut::Evaluation evaluation;
    taut::Trajectory truth;
    if (!options.truth.empty()) truth = scoreTrajectories(options, evaluation);
    if (!options.map.map.empty())
    {
        taut::MapOptions map = options.map;
        if (evaluation.trajectory)
            map.T_truth_map = evaluation.trajectory->absolute.T_truth_estimate;
        taut::Executor executor(options.threads);
        evaluation.map = taut::scoreMapFile(map, executor);
    }
    std::cout << (options.json ? scoresAsJson(evaluation) : scoresAsText(evaluation));
    std::cout.flush();
    if (!options.plot_folder.empty())
        taut::plotScores(*evaluation.trajectory, truth, options.plot_folder, options.plot_format);
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-evaluate",
        [&]
        {
            if (const auto options = parse(argc, argv)) run(*options);
        });
}
