#include "Registration.h"

#include <algorithm>
#include <cmath>

#include "Stopwatch.h"
#include "gaps.h"
#include "taut/odometry/PoseSearch.h"

namespace taut
{
namespace
{
/** Share of the prediction's covariance that is left to explain residuals after each look-up of
 * correspondences, since an estimate takes its place: the kernel closes step by step. */
constexpr double kStillPredicted = 0.25;

constexpr double kClearlyBetter = 1.1;  // features explained, to those by what was tried before
constexpr double kAsUsual = 0.8;        // the same to what is usual: less is searched for
constexpr std::size_t kSearched = 8;    // poses of the search that are worth an iteration
constexpr double kCarried = 2;          // [m/s] by which the velocity changes in a gap

/** How far a guess of the pose is from where the body is. */
LidarFactor::PoseCovariance covarianceOfGuess()
{
    LidarFactor::PoseCovariance P = LidarFactor::PoseCovariance::Zero();
    P.diagonal().head<3>().setConstant(square(0.4));  // [m]
    P.diagonal().tail<3>().setConstant(square(0.1));  // [rad]
    return P;
}

/** Seconds between a knot and the next earlier one. */
double stepAfter(const PreintegratedImu& motion, std::size_t knot)
{
    return toSeconds(motion.knots[knot].sample.t - motion.knots[knot + 1].sample.t);
}

/** The mean specific force from the last long gap on [m/s^2]. */
Vector3d specificForceAfterGap(const PreintegratedImu& motion)
{
    Vector3d sum = motion.knots[0].sample.accel;
    std::size_t n = 1;
    for (; n < motion.knots.size() && stepAfter(motion, n - 1) < kLongImuGap; n++)
        sum += motion.knots[n].sample.accel;
    return sum / static_cast<double>(n) - motion.bias_accel;
}
}  // namespace

bool hasLongGap(const PreintegratedImu& motion)
{
    for (std::size_t i = 0; i + 1 < motion.knots.size(); i++)
        if (stepAfter(motion, i) > kLongImuGap) return true;
    return false;
}

Registration::Registration(
    const OdometryConfig& config, const Map& map, const Solver& solver, MapScratch& scratch,
    Executor& executor, const NavPrior& previous, const PreintegratedImu& motion,
    const Features& features, const SweepPath& path)
    : config_(config),
      map_(map),
      solver_(solver),
      scratch_(scratch),
      executor_(executor),
      before_(previous.state),
      motion_(motion),
      features_(features),
      path_(path),
      lidar_(features, config.lidar_noise, executor),
      problem_(previous, motion, lidar_, path_, config.estimation),
      queries_(features.points.size())
{
    problem_.useLidar(false);
}

std::string Registration::iterate(LidarFactor::PoseCovariance unexplained, ScanReport& report)
{
    const EstimationConfig& config = config_.estimation;
    report.balance = config.inflation;
    const int most =
        motion_.rate_walk > 0 ? config.max_iterations_without_imu : config.max_iterations;
    for (int i = 0; i < most && !map_.empty(); i++)
    {
        Stopwatch watch;
        const std::vector<Vector3d>& world = lidar_.undistort(path_);
        for (std::size_t j = 0; j < world.size(); j++)
            queries_[j] = {
                world[j], features_.points[j].kind,
                (problem_.current().T_world_imu.p - world[j]).normalized()};
        map_.match(queries_, correspondences_, scratch_, executor_);
        watch.stage(report.times.match);

        lidar_.setCorrespondences(correspondences_, path_, unexplained, report.balance);
        unexplained *= kStillPredicted;
        report.correspondences = static_cast<int>(std::count_if(
            correspondences_.begin(), correspondences_.end(),
            [](const Correspondence& c) { return c.surface != Surface::None; }));
        report.lidar_used = report.correspondences >= config.min_correspondences;
        problem_.useLidar(report.lidar_used);
        if (config.balance && i > 0) report.balance = balanceOf(report.correspondences);
        problem_.setBalance(report.balance);

        const SolveReport solved = solver_.solve(problem_);
        if (!solved.failure.empty()) return solved.failure;
        report.iterations = i + 1;
        report.cost = solved.final_cost;
        report.converged = solved.last_step < config.min_step;
        if (report.converged && i > 0) break;
    }
    report.inlier_weight = lidar_.inlierWeight(path_);
    return {};
}

double Registration::balanceOf(int matches) const
{
    const EstimationConfig& config = config_.estimation;
    if (matches < config.balance_min_matches) return config.inflation;
    const double spread = std::sqrt(lidar_.fit(path_, 1.0).reducedChi2());
    return config.inflation * std::clamp(spread, 0.3, 10.0);
}

LidarFactor::PoseCovariance Registration::startAfterGap(double usual_share)
{
    const NavState predicted = problem_.current();
    MotionPrior carried;
    carried.v_world = before_.v_world;
    carried.velocity_sigma = kCarried;
    problem_.setMotionPrior(carried);

    NavState best = predicted;
    double most = -1;
    const auto attempt = [&](const NavState& start)
    {
        ScanReport tried;
        problem_.startFrom(start);
        const std::string failure = iterate(covarianceOfGuess(), tried);
        if (!failure.empty() || !(tried.inlier_weight > kClearlyBetter * most)) return;
        most = tried.inlier_weight;
        best = start;
    };
    attempt(predicted);
    // What was measured at both ends of the gap says little of what was between. The body may have
    // gone on at its speed or stopped on the way; where the clocks jumped it has not gone at all.
    NavState gone = before_;
    gone.t = predicted.t;
    const Vector3d way = motion_.duration() * before_.v_world;
    for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0})
    {
        gone.T_world_imu.p = before_.T_world_imu.p + share * way;
        attempt(gone);
    }
    if (most < kAsUsual * usual_share * static_cast<double>(features_.points.size()))
    {
        problem_.startFrom(gone);
        for (const Pose& pose : likelyPoses())
        {
            gone.T_world_imu = pose;
            attempt(gone);
        }
    }
    problem_.startFrom(best);
    return covarianceOfGuess();
}

std::vector<Pose> Registration::likelyPoses()
{
    const Pose T_imu_world = problem_.current().T_world_imu.inverse();
    const std::vector<Vector3d>& world = lidar_.undistort(path_);
    std::vector<MapPoint> scan;
    scan.reserve(world.size());
    for (std::size_t i = 0; i < world.size(); i++)
    {
        const Vector3d p = T_imu_world * world[i];
        scan.push_back({p, features_.points[i].kind, -p.normalized()});
    }
    return PoseSearch(scan, map_, executor_)
        .bestOf(
            PoseSearch::posesAfter(motion_.duration(), before_, specificForceAfterGap(motion_)),
            kSearched);
}
}  // namespace taut
