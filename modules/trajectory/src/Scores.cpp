#include "taut/trajectory/Scores.h"

#include <algorithm>
#include <cstdio>

namespace taut
{
namespace
{
void refuseTooLittle(const Scores& scores, const ScoreOptions& options)
{
    char text[200];
    if (scores.pairs.size() < options.min_poses)
    {
        std::snprintf(
            text, sizeof text,
            "refused: only %zu of the %s's %zu poses have %s at their time, %zu are needed",
            scores.pairs.size(), scores.at_truth_poses ? "truth" : "estimate",
            scores.at_truth_poses ? scores.truth_poses : scores.estimate_poses,
            scores.at_truth_poses ? "an estimate" : "a truth", options.min_poses);
        throw ScoreRefused(text);
    }
    if (scores.coverage.share < options.min_coverage)
    {
        std::snprintf(
            text, sizeof text,
            "refused: the estimate covers %.1f %% of the truth's %.3f s, %.1f %% are needed",
            100 * scores.coverage.share, scores.coverage.truth_span, 100 * options.min_coverage);
        throw ScoreRefused(text);
    }
}
}  // namespace

AbsoluteError absoluteError(const PosePairs& pairs, const Pose& T_truth_estimate)
{
    AbsoluteError out;
    out.T_truth_estimate = T_truth_estimate;
    std::vector<double> position, rotation;
    for (const PosePair& pair : pairs)
    {
        const Pose error = pair.truth.inverse() * (out.T_truth_estimate * pair.estimate);
        position.push_back(error.p.norm());
        rotation.push_back(angleOf(error.R) * kDegreesPerRadian);
        out.errors.push_back({pair.t, position.back(), rotation.back()});
    }
    out.position = statisticsOf(std::move(position));
    out.rotation_deg = statisticsOf(std::move(rotation));
    return out;
}

Coverage coverageOf(const Trajectory& truth, const Trajectory& estimate, Duration max_gap)
{
    Coverage out;
    if (truth.size() < 2) return out;
    const Time begin = truth.front().t, end = truth.back().t;
    out.truth_span = toSeconds(end - begin);
    if (estimate.empty()) return out;
    if (max_gap <= 0) max_gap = 3 * medianSpacing(estimate);
    Duration covered = 0, largest = 0;
    for (std::size_t i = 1; i < estimate.size(); i++)
    {
        const Duration spacing = estimate[i].t - estimate[i - 1].t;
        largest = std::max(largest, spacing);
        const Time a = std::max(begin, estimate[i - 1].t), b = std::min(end, estimate[i].t);
        if (spacing <= max_gap && b > a) covered += b - a;
    }
    out.share = toSeconds(covered) / out.truth_span;
    out.late_start = toSeconds(std::max<Duration>(0, estimate.front().t - begin));
    out.early_end = toSeconds(std::max<Duration>(0, end - estimate.back().t));
    out.largest_gap = toSeconds(largest);
    return out;
}

Scores scoreTrajectory(
    const Trajectory& truth, const Trajectory& estimate, const ScoreOptions& options)
{
    Scores scores;
    scores.pairs = pairPoses(truth, estimate, options.max_truth_gap, options.max_estimate_gap);
    scores.at_truth_poses = isSparser(truth, estimate);
    const PosePairs& pairs = scores.pairs;
    scores.truth_poses = truth.size();
    scores.estimate_poses = estimate.size();
    scores.coverage = coverageOf(truth, estimate, options.max_estimate_gap);
    refuseTooLittle(scores, options);
    for (std::size_t i = 1; i < pairs.size(); i++)
    {
        scores.truth_path += (pairs[i].truth.p - pairs[i - 1].truth.p).norm();
        scores.estimate_path += (pairs[i].estimate.p - pairs[i - 1].estimate.p).norm();
    }
    scores.alignment = options.alignment;
    const bool given = options.alignment == Alignment::Given;
    scores.absolute =
        absoluteError(pairs, given ? options.T_truth_estimate : align(pairs, options.alignment));
    for (const double seconds : options.rpe_seconds)
        scores.over_time.push_back(relativeErrorOverTime(pairs, seconds));
    for (const double metres : options.rpe_metres)
        scores.over_distance.push_back(relativeErrorOverDistance(pairs, metres));
    scores.kitti = kittiSegmentErrors(pairs);
    scores.short_segments = shortSegmentErrors(pairs);
    return scores;
}
}  // namespace taut
