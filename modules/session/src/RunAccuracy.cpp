#include "RunAccuracy.h"

#include "RunPlots.h"
#include "taut/core/ThinnedSample.h"
#include "taut/core/format.h"
#include "taut/trajectory/Scores.h"

namespace taut
{
namespace
{
std::vector<std::string> row(const std::string& name, const Statistics& s, double factor = 1)
{
    if (s.count == 0) return {name, "none: too short", "", "", ""};
    std::vector<std::string> cells{name};
    for (const double value : {s.rmse, s.mean, s.median, s.max})
        cells.push_back(format("%.3g", factor * value));
    return cells;
}

/** Small lengths in mm. */
std::vector<std::string> rowOfLengths(const std::string& name, const Statistics& s)
{
    const bool small = s.max < 1;
    return row(name + (small ? " [mm]" : " [m]"), s, small ? 1000 : 1);
}

std::string length(double metres)
{
    return metres < 0.1 ? format("%.3g mm", 1000 * metres) : format("%.3g m", metres);
}

ReportTable errorTable(const Scores& s)
{
    ReportTable table{
        "Errors",
        "After alignment by a rotation and a translation (SE3). Relative errors are those of the "
        "motion over a time or a distance.",
        {"", "RMSE", "mean", "median", "largest"},
        {rowOfLengths("position", s.absolute.position),
         row("attitude [deg]", s.absolute.rotation_deg)}};
    const auto add = [&](const RelativeError& e, const char* unit)
    {
        table.rows.push_back(rowOfLengths(format("over %g %s", e.delta, unit), e.translation));
        table.rows.push_back(row(format("over %g %s [deg]", e.delta, unit), e.rotation_deg));
    };
    for (const RelativeError& e : s.over_time) add(e, "s");
    for (const RelativeError& e : s.over_distance) add(e, "m");
    return table;
}

ReportTable coverageTable(const Scores& s)
{
    ReportTable table{
        "What was compared",
        "",
        {},
        {{"poses", format(
                       s.at_truth_poses ? "%zu, scored at %zu of the truth" : "%zu, %zu with truth",
                       s.estimate_poses, s.pairs.size())},
         {"truth covered",
          format("%.1f %% of %.3f s", 100 * s.coverage.share, s.coverage.truth_span)},
         {"path", format("%.3f m true, %.3f m estimated", s.truth_path, s.estimate_path)}}};
    const auto add = [&](const char* name, const SegmentErrors& e)
    {
        if (e.all.count > 0)
            table.rows.push_back(
                {name, format(
                           "%.3f %%, %.5f deg/m over %zu", e.all.translation_percent,
                           e.all.rotation_deg_per_m, e.all.count)});
    };
    add("segments of 5 to 40 m", s.short_segments);
    add("segments of 100 to 800 m", s.kitti);
    return table;
}

std::vector<ReportPlot> errorPlots(const AbsoluteError& error)
{
    ThinnedSample<PoseError> sample(kMostSamples);
    for (const PoseError& e : error.errors) sample.add(e);
    ReportPlot position{"Error of the position", "m", "After alignment.", false, {}, {}};
    ReportPlot attitude{"Error of the attitude", "deg", "After alignment.", false, {}, {}};
    position.curves = {{"error", {}, {}}};
    attitude.curves = {{"error", {}, {}}};
    for (const PoseError& e : sample.items())
    {
        position.times.push_back(e.t);
        position.curves[0].values.push_back(static_cast<float>(e.position));
        attitude.curves[0].values.push_back(static_cast<float>(e.rotation_deg));
    }
    attitude.times = position.times;
    return {position, attitude};
}

/** The truth in the run's world, while the run lasted. */
std::vector<Vector3d> pathOf(
    const Trajectory& truth, const Trajectory& estimate, const Pose& T_estimate_truth)
{
    ThinnedSample<Vector3d> sample(kMostSamples);
    for (const StampedPose& pose : truth)
        if (pose.t >= estimate.front().t && pose.t <= estimate.back().t)
            sample.add(T_estimate_truth * pose.T_world_imu.p);
    return sample.items();
}
}  // namespace

ReportAccuracy accuracyOf(const Trajectory& truth, const Trajectory& estimate)
{
    ReportAccuracy accuracy;
    try
    {
        const Scores scores = scoreTrajectory(truth, estimate);
        accuracy.headline = format(
            "Position %s, attitude %.3g deg (RMSE against the truth, after alignment).",
            length(scores.absolute.position.rmse).c_str(), scores.absolute.rotation_deg.rmse);
        accuracy.tables = {errorTable(scores), coverageTable(scores)};
        accuracy.plots = errorPlots(scores.absolute);
        accuracy.path = pathOf(truth, estimate, scores.absolute.T_truth_estimate.inverse());
    }
    catch (const std::runtime_error& e)
    {
        accuracy.headline = std::string("Not scored: ") + e.what();
    }
    return accuracy;
}
}  // namespace taut
