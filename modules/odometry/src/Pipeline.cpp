#include "taut/odometry/Pipeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "StartInMotion.h"

namespace taut
{
namespace
{
std::string format(const char* text, double value)
{
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, text, value);
    return buffer;
}

constexpr double kImuGap = 0.1;    // [s] worth a warning
constexpr double kLidarGap = 0.5;  // [s]

// Passes over the first scans of a start in motion, and what of their outcome is worth a warning.
constexpr int kBootstrapPasses = 12;
constexpr double kUnsettled = 20;      // changes that are negligible
constexpr double kWrongGravity = 1.0;  // [m/s^2] off what it is on Earth
constexpr double kWorse = 1.3;         // misfit of a pass to that of the one before
constexpr double kNoBetter = 0.5;      // change by a pass to that by the one before

// Where else to begin: a vehicle's speed along each horizontal axis of the body.
constexpr double kOtherSpeed = 10;  // [m/s]
const Vector3d kOtherStarts[] = {
    Vector3d::UnitX(), -Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitY()};
}  // namespace

Pipeline::Pipeline(
    const OdometryConfig& config, Executor& executor, const WarningSink& warn, ResultSink results)
    : config_(config),
      warn_(warn),
      results_(std::move(results)),
      odometry_(config, executor, warn),
      initializer_(config.initialization, warn)
{
    if (!config.preintegrator->needsImu()) beginWithoutImu();
}

void Pipeline::add(const ImuSample& sample)
{
    if (mode_ == Mode::WithoutImu)
    {
        if (config_.preintegrator->needsImu() && warn_)
            warn_(
                {sample.t, "late_imu",
                 "IMU samples appear after the estimation has started without them: ignored"});
        return;
    }
    mode_ = Mode::WithImu;
    if (!imu_.empty() && toSeconds(sample.t - imu_.back().t) > kImuGap && warn_)
        warn_(
            {imu_.back().t, "imu_gap",
             format("no IMU sample for %.3f s", toSeconds(sample.t - imu_.back().t))});
    imu_.push_back(sample);
    if (!initialization_ && initializer_.add(sample)) begin(*initializer_.result());
    processReady(false);
}

void Pipeline::add(Scan scan)
{
    waiting_.push_back(std::move(scan));
    if (mode_ == Mode::Undecided &&
        toSeconds(waiting_.back().end - waiting_.front().end) >= config_.imu_wait)
    {
        if (warn_)
            warn_(
                {waiting_.front().end, "no_imu",
                 format(
                     "no IMU sample in the first %.1f s of scans: the motion between scans is "
                     "taken as constant velocity instead",
                     config_.imu_wait)});
        beginWithoutImu();
    }
    processReady(false);
}

void Pipeline::finish()
{
    if (mode_ == Mode::Undecided && !waiting_.empty())
    {
        if (warn_)
            warn_(
                {waiting_.front().end, "no_imu",
                 "the recording has no IMU sample: constant velocity instead"});
        beginWithoutImu();
    }
    if (mode_ == Mode::WithImu && !initialization_ && initializer_.finish())
        begin(*initializer_.result());
    processReady(true);
}

void Pipeline::begin(const Initialization& initialization)
{
    initialization_ = initialization;
    odometry_.start(initialization, true);
}

void Pipeline::beginWithoutImu()
{
    // Nothing is known but that the world starts here, level, with an unknown velocity.
    mode_ = Mode::WithoutImu;
    Initialization start;
    start.at_rest = false;
    NavState::Vector sigma;
    sigma << Vector3d::Constant(1e-5), Vector3d::Constant(10.0), Vector3d::Constant(1e-5),
        Vector3d::Constant(1e-4), Vector3d::Constant(1e-4);
    start.estimate.covariance = sigma.cwiseAbs2().asDiagonal();
    start.estimate.state.t = waiting_.empty() ? 0 : waiting_.front().stamp - 1;
    initialization_ = start;
    if (start.estimate.state.t != 0) odometry_.start(start, false);
}

void Pipeline::processReady(bool all)
{
    if (!initialization_) return;
    if (!odometry_.started() && !waiting_.empty())
    {
        initialization_->estimate.state.t = waiting_.front().stamp - 1;
        odometry_.start(*initialization_, false);
    }
    if (!initialization_->at_rest && !bootstrapped_)
    {
        if (readyScans() < kBootstrapScans && !all) return;
        bootstrap();
    }
    for (std::size_t ready = all ? waiting_.size() : readyScans(); ready > 0; ready--)
    {
        process(waiting_.front());
        waiting_.pop_front();
    }
}

std::size_t Pipeline::readyScans() const
{
    if (!withImu()) return waiting_.size();
    std::size_t n = 0;
    while (n < waiting_.size() && !imu_.empty() && imu_.back().t >= waiting_[n].end) n++;
    return n;
}

std::vector<ScanResult> Pipeline::tryStart(const Initialization& start)
{
    odometry_.start(start, withImu());
    std::vector<ScanResult> results;
    for (std::size_t i = 0; i < std::min(waiting_.size(), kBootstrapScans); i++)
        if (waiting_[i].end > odometry_.time())
            results.push_back(odometry_.process(waiting_[i], imu_));
    return results;
}

TriedStart Pipeline::settle(const Initialization& initialization)
{
    // In motion, the first scan is undistorted with an unknown velocity and makes a wrong map, and
    // the mean specific force is not gravity. The scans after it tell both: start again with what
    // they tell, as well known as it still changes, until map and motion agree.
    Initialization start = initialization, widened = start;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double last_misfit = kUnknown, last_change = kUnknown;
    TriedStart best;
    best.start = initialization;
    bool sharpen = true;
    for (int pass = 0; pass < kBootstrapPasses; pass++)
    {
        const std::vector<ScanResult> results = tryStart(start);
        if (results.size() < 2) break;
        const Revision revision = revisionOf(results);
        const double misfit = misfitOf(results);
        if (sharpen && misfit > kWorse * last_misfit && revision.change() > kNoBetter * last_change)
        {
            // Known too well too early, false matches agree with each other.
            sharpen = false;
            start = widened;
            continue;
        }
        last_misfit = misfit;
        last_change = revision.change();
        const double merit = misfit * std::max(1.0, revision.change());
        if (merit < best.merit)
            best = {
                start, merit, revision.change(), revision.gravity_error, matchedShareOf(results)};
        if (revision.change() <= 1) break;
        widened.estimate.state = revised(start.estimate.state, revision);
        start = widened;
        if (sharpen) start.estimate.covariance = sharpened(widened.estimate.covariance, revision);
    }
    return best;
}

void Pipeline::bootstrap()
{
    bootstrapped_ = true;
    TriedStart best = settle(*initialization_);
    // False matches hold a start near the velocity that it began with: where few of the features
    // match, or the passes do not come to rest, others may agree with more of what the scans see.
    if (!best.convincing())
    {
        for (const Vector3d& direction : kOtherStarts)
        {
            Initialization other = *initialization_;
            NavState& x = other.estimate.state;
            x.v_world += x.T_world_imu.R * Vector3d(kOtherSpeed * direction);
            const TriedStart tried = settle(other);
            if (tried.merit < best.merit) best = tried;
        }
    }
    if ((best.change > kUnsettled || best.gravity_error > kWrongGravity) && warn_)
        warn_(
            {best.start.estimate.state.t, "start_unsettled",
             "the first scans do not agree on velocity and gravity at the start: the beginning is "
             "less accurate"});
    odometry_.start(best.start, withImu());
}

void Pipeline::process(const Scan& scan)
{
    if (scan.end <= odometry_.time())
    {
        if (warn_ && scan.end > initialization_->estimate.state.t)
            warn_(
                {scan.end, "scan_order",
                 "a scan that does not end after the one before it is skipped"});
        return;
    }
    const double interval = toSeconds(scan.end - odometry_.time());
    if (interval > kLidarGap && warn_)
        warn_({odometry_.time(), "lidar_gap", format("no scan for %.2f s", interval)});
    const ScanResult result = odometry_.process(scan, imu_);
    if (!result.lidar_used && warn_ && result.iterations > 0)
        warn_(
            {scan.end, "few_correspondences",
             format(
                 "only %.0f correspondences: the state follows the IMU alone",
                 result.correspondences)});
    if (isDoubtful(result) && warn_)
        warn_(
            {scan.end, "pose_doubtful",
             format("only %.0f %% of the matched points fit the map", 100 * result.fit()) +
                 format(
                     ", where %.0f %% did: the pose may be lost from here on",
                     100 * result.usual_fit)});
    results_(scan, result);

    // Samples before the new state are history, but for the one to interpolate with.
    const auto keep = std::lower_bound(
        imu_.begin(), imu_.end(), odometry_.time(),
        [](const ImuSample& s, Time t) { return s.t < t; });
    if (keep - imu_.begin() > 1) imu_.erase(imu_.begin(), keep - 1);
}
}  // namespace taut
