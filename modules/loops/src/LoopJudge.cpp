#include "taut/loops/LoopJudge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "taut/core/format.h"
#include "taut/loops/SubmapRegistration.h"

namespace taut
{
namespace
{
// How far off a start may be for a registration to find its way.
constexpr double kReach = 0.5;        // [m], and as far turned at the lever
constexpr double kFurthest = 6;       // [m] that starts are tried around a guess
constexpr double kMostTurned = 0.4;   // [rad]
constexpr std::size_t kGlance = 200;  // points that tell which starts are worth it
constexpr std::size_t kBest = 3;      // starts that are followed
constexpr double kMostTilted = 0.1;   // [rad] between what both take for up
// Starts around a result that have to lead back to it.
constexpr double kAside = 0.25;  // [m], and as far turned at the lever
/** From -reach to reach about a step apart; 0 alone where the reach is within a step. */
std::vector<double> stepsWithin(double reach, double step)
{
    const int half = reach <= step ? 0 : static_cast<int>(std::ceil(reach / step));
    std::vector<double> steps;
    for (int i = -half; i <= half; i++) steps.push_back(half == 0 ? 0 : i * reach / half);
    return steps;
}

double deviation(const Matrix6d& covariance, int from, int to)
{
    double largest = 0;
    for (int i = from; i < to; i++) largest = std::max(largest, covariance(i, i));
    return std::sqrt(largest);
}

/** T moved by so much and turned about the vertical through the middle of the points. */
Pose movedAside(const Pose& T_from_to, const Extent& extent, const Vector3d& by, double yaw)
{
    const Matrix3d R = expSO3({0, 0, yaw});
    return T_from_to * Pose{R, extent.middle - R * extent.middle + by};
}

/** The guess, and others around it as far as it is uncertain. */
std::vector<Pose> startsAround(const LoopCandidate& candidate, const Extent& extent)
{
    const double apart = std::min(2 * deviation(candidate.covariance, 0, 2), kFurthest);
    const double above = std::min(2 * deviation(candidate.covariance, 2, 3), kFurthest);
    const double turned = std::min(2 * deviation(candidate.covariance, 3, 6), kMostTurned);
    std::vector<Pose> starts;
    for (const double x : stepsWithin(apart, kReach))
        for (const double y : stepsWithin(apart, kReach))
            for (const double z : stepsWithin(above, kReach))
                for (const double yaw : stepsWithin(turned, kReach / extent.lever))
                    if (std::hypot(x, y) <= apart + 1e-9)
                        starts.push_back(movedAside(candidate.T_from_to, extent, {x, y, z}, yaw));
    return starts;
}

std::vector<MapPoint> everyNth(const std::vector<MapPoint>& points, std::size_t count)
{
    std::vector<MapPoint> some;
    const std::size_t stride = points.size() / count + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
    return some;
}

/** The best fit from where a glance says that it is worth it. */
SubmapFit bestFit(
    SubmapRegistration& registration, const std::vector<MapPoint>& points,
    const LoopCandidate& candidate)
{
    std::vector<Pose> starts = startsAround(candidate, extentOf(points));
    if (starts.size() > kBest)
    {
        const std::vector<MapPoint> glance = everyNth(points, kGlance);
        std::vector<std::pair<double, std::size_t>> ranked;
        for (std::size_t i = 0; i < starts.size(); i++)
            ranked.emplace_back(-registration.inlierWeight(glance, starts[i], kReach), i);
        std::sort(ranked.begin(), ranked.end());
        std::vector<Pose> best;
        for (std::size_t i = 0; i < kBest; i++) best.push_back(starts[ranked[i].second]);
        starts = best;
    }
    SubmapFit best;
    for (const Pose& start : starts)
    {
        const SubmapFit fit = registration.align(points, start, kReach);
        if (fit.converged && (!best.converged || fit.weight > best.weight)) best = fit;
    }
    return best;
}

/** How far two poses are apart in the directions that the overlap shows. */
struct Difference
{
    double position = 0, angle = 0;
    void include(const PoseDirections& seen, const Pose& a, const Pose& b)
    {
        Vector6d coordinates = seen.basis.partialPivLu().solve(rightErrorTo(a, b));
        for (int i = 0; i < 6; i++)
            if (seen.isOpen(i)) coordinates[i] = 0;
        const Vector6d apart = seen.axes * coordinates;
        position = std::max(position, apart.head<3>().norm());
        angle = std::max(angle, apart.tail<3>().norm() / seen.lever);
    }
};

/** Information of a loop: what the residuals say, less in what both submaps have in common wrong;
 * none in directions that the overlap does not show. The fewer points show a direction, the more of
 * an error in common comes through in it. */
Matrix6d informationOf(const PoseDirections& seen, const LoopJudgeConfig& config, int& directions)
{
    Vector6d information = Vector6d::Zero();
    directions = 0;
    for (int i = 0; i < 6; i++)
    {
        if (seen.isOpen(i)) continue;
        directions++;
        const Vector6d axis = seen.axes.col(i);
        const double common =
            square(config.position_sigma) * axis.head<3>().squaredNorm() +
            square(seen.lever * config.rotation_sigma) * axis.tail<3>().squaredNorm();
        const double share = std::min(1.0, 6 * seen.shown[i] / seen.shown.sum());
        information[i] = 1 / (1 / seen.shown[i] + common / share);
    }
    const Matrix6d to_axes = seen.basis.inverse();
    return to_axes.transpose() * information.asDiagonal() * to_axes;
}
}  // namespace

void LoopJudgeConfig::declare(ConfigSection& s)
{
    s.key("points", points, {100, 1e6}, "of each submap that are registered");
    s.key("min_overlap", min_overlap, {0, 1}, "of what both could see");
    s.key("min_inliers", min_inliers, {0, 1}, "of these on a surface of the other");
    s.key("max_conflicts", max_conflicts, {0, 1}, "of the common cells in space seen free");
    s.key(
        "max_conflicts_between", max_conflicts_between, {0, 1},
        "the same between recordings: furniture moves");
    s.key("min_cells", min_cells, {1, 1e6}, "of 0.5 m that both could see");
    s.key("min_sectors", min_sectors, {1, 8}, "of eight around that hold inliers");
    s.key("max_disagreement", max_disagreement, kPositive, "m, of the registrations");
    s.key("max_angle_disagreement", max_angle_disagreement, kPositive, "rad, of these");
    s.key("min_directions", min_directions, {1, 6}, "of a pose that the overlap shows");
    s.key("position_sigma", position_sigma, kPositive, "m, of a loop besides its residuals");
    s.key("rotation_sigma", rotation_sigma, kPositive, "rad");
}

LoopClosure LoopJudge::judge(
    const LoopCandidate& candidate, const SubmapView& from, const SubmapView& to) const
{
    LoopClosure loop;
    loop.from = candidate.from;
    loop.to = candidate.to;
    loop.T_from_to = candidate.T_from_to;
    loop.source = candidate.source;
    loop.reason = faultOf(candidate, from, to, loop);
    loop.verdict = loop.reason.empty() ? Verdict::Pending : Verdict::Refused;
    return loop;
}

std::string LoopJudge::faultOf(
    const LoopCandidate& candidate, const SubmapView& from, const SubmapView& to,
    LoopClosure& loop) const
{
    const auto most = static_cast<std::size_t>(config_.points);
    const std::vector<MapPoint> of_from = mapPointsOf(*from.submap, most);
    const std::vector<MapPoint> of_to = mapPointsOf(*to.submap, most);
    SubmapRegistration on_from(*from.map, executor_), on_to(*to.map, executor_);
    const SubmapFit fit = bestFit(on_from, of_to, candidate);
    if (!fit.converged) return "the registration finds no fit";
    loop.T_from_to = fit.T_from_to;
    loop.evidence.residual = fit.residual;

    // Gravity tells one from another that hangs upside down.
    const double tilt = std::acos(std::clamp(
        (fit.T_from_to.R * to.submap->up_submap).dot(from.submap->up_submap), -1.0, 1.0));
    if (tilt > kMostTilted) return format("gravity: tilted by %.1f degrees", tilt * 180 / M_PI);

    // What both could see, each with the eyes of the other.
    const Pose T_to_from = fit.T_from_to.inverse();
    const std::string conflict = conflictOf(
        commonView(
            of_to, fit.T_from_to,
            visibilityOf(of_to, on_to.normalsOf(of_to), fit.T_from_to, *from.submap),
            on_from.onSurface(of_to, fit.T_from_to)),
        commonView(
            of_from, T_to_from,
            visibilityOf(of_from, on_from.normalsOf(of_from), T_to_from, *to.submap),
            on_to.onSurface(of_from, T_to_from)),
        {of_to.size(), of_from.size()},
        candidate.between_recordings ? config_.max_conflicts_between : config_.max_conflicts,
        loop.evidence);
    if (!conflict.empty()) return conflict;

    const Extent extent = extentOf(of_to);
    const PoseDirections seen = directionsOf(fit.hessian, extent);
    loop.information = informationOf(seen, config_, loop.evidence.directions);
    if (loop.evidence.directions < config_.min_directions)
        return format("degenerate: only %d of 6 directions are seen", loop.evidence.directions);

    // The other way round, and from beside: where the overlap shows it, the same pose.
    Difference difference;
    const SubmapFit back = on_to.align(of_from, T_to_from, kReach / 2);
    if (!back.converged) return "the registration the other way finds no fit";
    difference.include(seen, fit.T_from_to, back.T_from_to.inverse());
    for (const double side : {-1.0, 1.0})
    {
        const Pose aside = movedAside(
            fit.T_from_to, extent, {side * kAside, kAside, 0}, side * kAside / extent.lever);
        const SubmapFit again = on_from.align(of_to, aside, kReach);
        if (!again.converged) return "another start finds no fit";
        difference.include(seen, fit.T_from_to, again.T_from_to);
    }
    loop.evidence.disagreement = difference.position;
    if (difference.position > config_.max_disagreement ||
        difference.angle > config_.max_angle_disagreement)
        return format(
            "disagreement: registrations differ by %.0f mm and %.2f degrees",
            1e3 * difference.position, difference.angle * 180 / M_PI);
    return "";
}

std::string LoopJudge::conflictOf(
    const CommonView& a, const CommonView& b, const std::array<std::size_t, 2>& points,
    double max_conflicts, LoopEvidence& e) const
{
    const auto share = [](double part, double all) { return all > 0 ? part / all : 0; };
    e.overlap = std::max(
        share(a.points, static_cast<double>(points[0])),
        share(b.points, static_cast<double>(points[1])));
    e.cells = a.cells + b.cells;
    e.inliers = std::min(share(a.on_surface, a.points), share(b.on_surface, b.points));
    e.conflicts = share(a.conflicts + b.conflicts, e.cells);
    const int sectors = std::max(a.sectors, b.sectors);
    if (e.overlap < config_.min_overlap || e.cells < config_.min_cells)
        return format("overlap: %.0f %% in %d cells", 100 * e.overlap, e.cells);
    if (e.inliers < config_.min_inliers)
        return format("fit: %.0f %% of the common points on a surface", 100 * e.inliers);
    if (e.conflicts > max_conflicts)
        return format(
            "free space: %.1f %% of the common cells lie where the other saw through",
            100 * e.conflicts);
    if (sectors < config_.min_sectors)
        return format("overlap: on one side only, %d sectors of 8", sectors);
    return "";
}
}  // namespace taut
