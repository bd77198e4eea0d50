#include "taut/evaluation/Report.h"

#include <nlohmann/json.hpp>

#include "taut/core/format.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut
{
namespace
{
using Json = nlohmann::ordered_json;

std::string row(const std::string& name, const char* unit, const Statistics& s)
{
    if (s.count == 0)
        return format("%-24s %-5s %11s\n", name.c_str(), unit, "none: too short or too sparse");
    return format(
        "%-24s %-5s %11.6f %11.6f %11.6f %11.6f %7zu\n", name.c_str(), unit, s.rmse, s.mean,
        s.median, s.max, s.count);
}

/** Where there is nothing to tell, null: a zero would read as perfect. */
Json toJson(const Statistics& s)
{
    if (s.count == 0) return nullptr;
    return {
        {"rmse", s.rmse},
        {"mean", s.mean},
        {"median", s.median},
        {"max", s.max},
        {"count", s.count}};
}

std::string rows(const std::string& over, const RelativeError& e)
{
    return row("RPE over " + over + " position", "m", e.translation) +
           row("RPE over " + over + " rotation", "deg", e.rotation_deg);
}

std::string row(const std::string& name, const SegmentErrors& e)
{
    if (e.all.count == 0) return format("%-24s none: the path is too short\n", name.c_str());
    return format(
        "%-24s %.4f %%, %.6f deg/m over %zu segments\n", name.c_str(), e.all.translation_percent,
        e.all.rotation_deg_per_m, e.all.count);
}

Json toJson(const Pose& T)
{
    Json rows = Json::array();
    for (int i = 0; i < 3; i++) rows.push_back({T.R(i, 0), T.R(i, 1), T.R(i, 2), T.p[i]});
    return rows;
}

Json toJson(const std::vector<RelativeError>& errors, const char* delta_name)
{
    Json out = Json::array();
    for (const RelativeError& e : errors)
        out.push_back(
            {{delta_name, e.delta},
             {"translation_m", toJson(e.translation)},
             {"rotation_deg", toJson(e.rotation_deg)}});
    return out;
}

Json toJson(const SegmentError& e)
{
    Json out{{"count", e.count}};
    if (e.length > 0) out["length_m"] = e.length;
    out["translation_percent"] = e.count > 0 ? Json(e.translation_percent) : Json();
    out["rotation_deg_per_m"] = e.count > 0 ? Json(e.rotation_deg_per_m) : Json();
    return out;
}

Json toJson(const SegmentErrors& errors)
{
    Json out = toJson(errors.all);
    for (const SegmentError& e : errors.by_length) out["by_length"].push_back(toJson(e));
    return out;
}

Json toJson(const Coverage& c)
{
    return {
        {"share", c.share},
        {"truth_span_s", c.truth_span},
        {"late_start_s", c.late_start},
        {"early_end_s", c.early_end},
        {"largest_gap_s", c.largest_gap}};
}

Json toJson(const PointScores& p)
{
    return {
        {"scans", p.scans},
        {"truth_scans", p.truth_scans},
        {"points", p.points},
        {"missing_points", p.missing},
        {"rmse_m", p.rmse},
        {"mean_m", p.mean},
        {"max_m", p.max},
        {"median_scan_rmse_m", p.median_scan},
        {"worst_scan_rmse_m", p.worst_scan},
        {"worst_scan_stamp_ns", p.worst_stamp}};
}

std::string pointRows(const PointScores& p)
{
    std::string out = format(
        "%-24s %-5s %11.6f %11.6f %11s %11.6f %7zu\n", "undistorted points", "m", p.rmse, p.mean,
        "", p.max, p.points);
    out += format(
        "  in %zu of %zu scans, %zu points missing; RMSE of a scan: median %.6f m, worst %.6f m at "
        "%s s\n",
        p.scans, p.truth_scans, p.missing, p.median_scan, p.worst_scan,
        formatSeconds(p.worst_stamp).c_str());
    return out;
}

std::string loopRows(const LoopScores& s)
{
    return format(
        "loops      %d in the graph, %d wrong: precision %.3f\n"
        "revisits   %d submaps, %d recognised: recall %.3f\n"
        "errors     largest %.3f m; NEES %.2f a degree of freedom\n",
        s.loops, s.wrong, s.precision(), s.revisits, s.recognised, s.recall(), s.largest_error,
        s.nees);
}

/** Where there are no loops or revisits, null: there is no share of nothing. */
Json toJson(const LoopScores& s)
{
    return {
        {"loops", s.loops},
        {"wrong", s.wrong},
        {"precision", s.loops > 0 ? Json(s.precision()) : Json()},
        {"revisits", s.revisits},
        {"recognised", s.recognised},
        {"recall", s.revisits > 0 ? Json(s.recall()) : Json()},
        {"largest_error_m", s.loops > 0 ? Json(s.largest_error) : Json()},
        {"nees_per_dof", s.loops > 0 ? Json(s.nees) : Json()}};
}

std::string truthRows(const MapTruthScores& t)
{
    std::string out = "map truth  ";
    out += t.cloud ? format("cloud of %zu points, %.3f m apart (median)\n", t.elements, t.spacing)
                   : format("mesh of %zu triangles, %.1f m^2\n", t.elements, t.area);
    out += "map laid   by " + t.alignment;
    if (t.surface)
        out += format(
            ": moved by %.4f m and %.4f deg in %d steps, %d directions shown, %.1f %% of the "
            "points within 0.5 m",
            t.T_truth_map.p.norm(), angleOf(t.T_truth_map.R) * kDegreesPerRadian,
            t.surface->iterations, t.surface->directions, 100 * t.surface->near_share);
    const MapErrors& e = t.errors;
    out += format(
        "\n\n%-24s %-5s %11s %11s %11s %11s %11s %9s\n%-24s %-5s %11.6f %11.6f %11.6f %11.6f "
        "%11.6f %9zu\n",
        "error", "unit", "rmse", "mean", "median", "95 %", "max", "count", "map to truth", "m",
        e.distance.rmse, e.distance.mean, e.distance.median, e.percentile95, e.distance.max,
        e.distance.count);
    if (e.left_out > 0) out += format("  %zu points beyond --map-reach left out\n", e.left_out);
    out += format(
        "completeness             %.2f %% of the truth has a point within %g m; %.2f %% of the "
        "points are within it\n",
        100 * e.completeness, e.within, 100 * e.near_share);
    return out;
}

std::string mapRows(const MapScores& m)
{
    std::string out = format("map        %zu points", m.points);
    if (m.not_finite > 0) out += format("; %zu more are not finite, left out", m.not_finite);
    out += "\n";
    if (m.truth) out += truthRows(*m.truth);
    out +=
        m.walls.planes == 0
            ? format("walls                    none: no planes in %zu windows\n", m.walls.windows)
            : format(
                  "walls                    %.6f m thick (median), 90 %% below %.6f m; %zu "
                  "planes in %zu windows of %g m\n",
                  m.walls.median, m.walls.percentile90, m.walls.planes, m.walls.windows,
                  WallThickness::kWindow);
    out += m.entropy.counted == 0
               ? std::string("mean map entropy         none: too few points\n")
               : format(
                     "mean map entropy         %.4f nat over %zu of %zu points, radius %g m\n",
                     m.entropy.mean, m.entropy.counted, m.entropy.points, MapEntropy::kRadius);
    return out;
}

Json toJson(const MapTruthScores& t)
{
    Json out{{"kind", t.cloud ? "cloud" : "mesh"}, {t.cloud ? "points" : "triangles", t.elements}};
    if (t.cloud)
        out["spacing_m"] = t.spacing;
    else
        out["area_m2"] = t.area;
    out["alignment"] = t.alignment;
    out["T_truth_map"] = toJson(t.T_truth_map);
    if (t.surface)
        out["icp"] = {
            {"steps", t.surface->iterations},
            {"directions", t.surface->directions},
            {"within_half_a_metre", t.surface->near_share}};
    const MapErrors& e = t.errors;
    out["distance_m"] = toJson(e.distance);
    out["distance_m"]["percentile_95"] = e.percentile95;
    out["left_out_points"] = e.left_out;
    out["within_m"] = e.within;
    out["points_within"] = e.near_share;
    out["completeness"] = e.completeness;
    out["samples"] = e.samples;
    return out;
}

Json toJson(const MapScores& m)
{
    Json out{{"points", m.points}, {"not_finite_points", m.not_finite}};
    if (m.truth) out["truth"] = toJson(*m.truth);
    const bool planes = m.walls.planes > 0, counted = m.entropy.counted > 0;
    out["walls"] = {
        {"window_m", WallThickness::kWindow},
        {"windows", m.walls.windows},
        {"planes", m.walls.planes},
        {"median_m", planes ? Json(m.walls.median) : Json()},
        {"percentile_90_m", planes ? Json(m.walls.percentile90) : Json()}};
    out["entropy"] = {
        {"radius_m", MapEntropy::kRadius},
        {"points", m.entropy.points},
        {"counted", m.entropy.counted},
        {"mean_nat", counted ? Json(m.entropy.mean) : Json()}};
    return out;
}

std::string trajectoryRows(const Scores& s)
{
    std::string out =
        s.at_truth_poses
            ? format(
                  "poses      %zu estimated; scored at %zu of the truth, which has fewer a "
                  "second\n",
                  s.estimate_poses, s.pairs.size())
            : format(
                  "poses      %zu estimated, %zu with truth\n", s.estimate_poses, s.pairs.size());
    out += format(
        "coverage   %.1f %% of %.3f s; starts %.3f s late, ends %.3f s early, largest gap %.3f s\n",
        100 * s.coverage.share, s.coverage.truth_span, s.coverage.late_start, s.coverage.early_end,
        s.coverage.largest_gap);
    out += format("path       %.3f m true, %.3f m estimated\n", s.truth_path, s.estimate_path);
    out += format(
        "alignment  %s\n\n%-24s %-5s %11s %11s %11s %11s %7s\n", nameOf(s.alignment).c_str(),
        "error", "unit", "rmse", "mean", "median", "max", "count");
    out += row("ATE position", "m", s.absolute.position);
    out += row("ATE rotation", "deg", s.absolute.rotation_deg);
    for (const RelativeError& e : s.over_time) out += rows(format("%g s", e.delta), e);
    for (const RelativeError& e : s.over_distance) out += rows(format("%g m", e.delta), e);
    out += row("KITTI 100..800 m", s.kitti);
    out += row("segments 5..40 m", s.short_segments);
    return out;
}

Json toJson(const Scores& s)
{
    Json out;
    out["truth_poses"] = s.truth_poses;
    out["estimate_poses"] = s.estimate_poses;
    out["paired_poses"] = s.pairs.size();
    out["scored_at"] = s.at_truth_poses ? "truth" : "estimate";
    out["coverage"] = toJson(s.coverage);
    out["truth_path_m"] = s.truth_path;
    out["estimate_path_m"] = s.estimate_path;
    out["alignment"] = nameOf(s.alignment);
    out["T_truth_estimate"] = toJson(s.absolute.T_truth_estimate);
    out["ate"]["position_m"] = toJson(s.absolute.position);
    out["ate"]["rotation_deg"] = toJson(s.absolute.rotation_deg);
    out["rpe"]["over_time"] = toJson(s.over_time, "delta_s");
    out["rpe"]["over_distance"] = toJson(s.over_distance, "delta_m");
    out["kitti_segments"] = toJson(s.kitti);
    out["short_segments"] = toJson(s.short_segments);
    return out;
}
}  // namespace

std::string scoresAsText(const Evaluation& e)
{
    std::string out;
    const auto add = [&out](const std::string& part) { out += (out.empty() ? "" : "\n") + part; };
    if (e.trajectory) add(trajectoryRows(*e.trajectory));
    if (e.points) out += pointRows(*e.points);
    if (e.loops) add(loopRows(*e.loops));
    if (e.map) add(mapRows(*e.map));
    return out;
}

std::string scoresAsJson(const Evaluation& e)
{
    Json out = e.trajectory ? toJson(*e.trajectory) : Json::object();
    if (e.points) out["points"] = toJson(*e.points);
    if (e.loops) out["loops"] = toJson(*e.loops);
    if (e.map) out["map"] = toJson(*e.map);
    return out.dump(2) + "\n";
}
}  // namespace taut
