#include "taut/odometry/Pipeline.h"

#include "StartInMotion.h"
#include "Synchronizer.h"
#include "gaps.h"
#include "taut/core/format.h"

namespace taut
{
namespace
{
/** Nothing is known but that the world begins at this scan, level, with an unknown velocity. */
Initialization startWithoutImu(const Scan& first)
{
    Initialization start;
    start.at_rest = false;
    NavState::Vector sigma;
    sigma << Vector3d::Constant(1e-5), Vector3d::Constant(10.0), Vector3d::Constant(1e-5),
        Vector3d::Constant(1e-4), Vector3d::Constant(1e-4);
    start.estimate.covariance = sigma.cwiseAbs2().asDiagonal();
    start.estimate.state.t = first.stamp - 1;  // a point is used if it is later than the state
    return start;
}
/** [s] for which an IMU bridges a direction that nothing shows: to decimetres, if it is a good one.
 */
constexpr double kOpenForLong = 10;
/** [m] that the body has gone meanwhile: one that turns in place is not lost. */
constexpr double kOpenWay = 5;
/** Share of the matches' information on the position: normals that err by a degree show as much. */
constexpr double kHardlyShown = 3e-4;
}  // namespace

Pipeline::Pipeline(OdometryConfig config, Executor& executor, WarningSink warn, EventSink events)
    : config_(std::move(config)),
      warn_(std::move(warn)),
      events_(std::move(events)),
      streams_(std::make_unique<Synchronizer>(config_.imu_wait, config_.imu_range, warn_)),
      initializer_(config_.initialization, warn_),
      odometry_(config_, executor, warn_),
      needs_imu_(config_.preintegrator->needsImu())
{
    if (!needs_imu_) streams_->runWithoutImu();
}

Pipeline::~Pipeline() = default;

bool Pipeline::withImu() const
{
    return streams_->imu() != Synchronizer::Imu::Absent;
}

std::size_t Pipeline::waiting() const
{
    return streams_->scans().size();
}

void Pipeline::add(const ImuSample& sample)
{
    if (!needs_imu_) return;
    streams_->add(sample);
    if (withImu() && !initialization_) initializer_.add(sample);
    advance();
}

void Pipeline::add(Scan scan)
{
    streams_->add(std::move(scan));
    advance();
}

void Pipeline::finish()
{
    if (finished_) return;
    finished_ = true;
    try
    {
        streams_->end();
        advance();
    }
    catch (...)
    {
        tellEnd();  // what was estimated is not lost with the scan that failed
        throw;
    }
    tellEnd();
}

void Pipeline::tellEnd()
{
    if (last_sweep_) events_(Refined{*last_sweep_, last_sweep_->end});
    last_sweep_.reset();
    events_(Ended{odometry_.started() ? odometry_.time() : 0});
}

void Pipeline::advance()
{
    findStart();
    if (!initialization_) return;
    if (!odometry_.started())
    {
        const bool enough = streams_->ready() >= kStartingScans || streams_->ended();
        if (!initialization_->at_rest && !enough) return;
        start();
    }
    while (streams_->ready() > 0)
    {
        process(streams_->scans().front());
        streams_->popScan();
    }
}

void Pipeline::findStart()
{
    if (initialization_) return;
    if (!withImu())
    {
        if (!streams_->scans().empty())
            initialization_ = startWithoutImu(streams_->scans().front());
        return;
    }
    const bool no_more = streams_->ended() || streams_->imu() == Synchronizer::Imu::Silent;
    if (no_more) initializer_.finish();
    initialization_ = initializer_.result();
    // While a rest is waited for, what lies before it is of no use.
    if (initialization_ || !initializer_.earliestStart()) return;
    streams_->forgetScansBefore(*initializer_.earliestStart());
    streams_->forgetSamplesBefore(*initializer_.earliestStart());
}

void Pipeline::start()
{
    if (initialization_->at_rest)
    {
        odometry_.start(*initialization_);
    }
    else
    {
        const StartInMotion found = findStartInMotion(
            *initialization_, [this](const Initialization& from) { return firstScansFrom(from); });
        if (!found.converged)
            warn(
                found.start.estimate.state.t, "start_unsettled",
                "the first scans do not agree on velocity and gravity at the start: the beginning "
                "is less accurate");
        odometry_.start(found.start);
    }
    events_(Started{*initialization_, withImu()});
}

const ImuSamples* Pipeline::samplesFor(const Scan& scan) const
{
    return streams_->tell(odometry_.time(), scan.end) ? &streams_->samples() : nullptr;
}

std::vector<ScanResult> Pipeline::firstScansFrom(const Initialization& from)
{
    odometry_.start(from);
    std::vector<ScanResult> results;
    std::size_t tried = 0;
    for (const Scan& scan : streams_->scans())
    {
        if (tried++ == kStartingScans) break;
        if (scan.end > odometry_.time())
            results.push_back(odometry_.process(scan, samplesFor(scan)));
    }
    return results;
}

void Pipeline::process(const Scan& scan)
{
    if (scan.end <= odometry_.time())
    {
        if (scan.end > initialization_->estimate.state.t)
            warn(
                scan.end, "scan_order",
                "a scan that does not end after the one before it is skipped");
        return;
    }
    const double interval = toSeconds(scan.end - odometry_.time());
    if (interval > kLidarGap)
        warn(odometry_.time(), "lidar_gap", format("no scan for %.2f s", interval));
    ScanResult result = odometry_.process(scan, samplesFor(scan));
    judge(result);
    refineLast(result);
    events_(Estimated{scan, result});
    last_sweep_ = std::move(result.sweep);
    estimated_++;
    streams_->forgetSamplesBefore(odometry_.time());
}

void Pipeline::refineLast(const ScanResult& next)
{
    if (!last_sweep_) return;
    // Without an IMU the second scan could move the first, where the map begins, only along a speed
    // that is not known.
    const bool moves = next.with_imu || estimated_ > 1;
    events_(Refined{*last_sweep_, moves ? next.previous : last_sweep_->end});
}

void Pipeline::judge(const ScanResult& result)
{
    const Time t = result.estimate.state.t;
    std::string cause;
    if (isDoubtful(result.report))
    {
        cause = "pose_doubtful";
        warn(
            t, cause,
            format(
                "only %.0f %% of the matched points fit the map, where %.0f %% did: the pose may "
                "be lost from here on",
                100 * result.report.fit(), 100 * result.report.usual_fit));
    }
    else if (!result.report.lidar_used && result.report.iterations > 0)
    {
        cause = "few_correspondences";
        warn(
            t, cause,
            format(
                "only %d correspondences: the state follows the %s alone",
                result.report.correspondences, result.with_imu ? "IMU" : "velocity"));
    }
    else if (!result.with_imu && withImu())
    {
        cause = "imu_silent";
    }
    else if (isOpenForLong(result))
    {
        cause = "position_open";
        if (cause != lost_)
            warn(
                t, cause,
                format(
                    "for %.0f s hardly any match has shown the position along one direction: the "
                    "IMU alone tells it",
                    kOpenForLong));
    }
    if (cause == lost_) return;
    if (!lost_.empty()) events_(Recovered{t, lost_});
    if (!cause.empty()) events_(Lost{t, cause});
    lost_ = cause;
}

bool Pipeline::isOpenForLong(const ScanResult& result)
{
    const auto& information = result.report.translation_information;  // ascending
    const double all = information[0] + information[1] + information[2];
    const Time t = result.estimate.state.t;
    if (!result.report.lidar_used || information[0] >= kHardlyShown * all)
        last_shown_ = result.estimate.state;
    if (!last_shown_ || toSeconds(t - last_shown_->t) <= kOpenForLong) return false;
    const Pose& now = result.estimate.state.T_world_imu;
    return (now.p - last_shown_->T_world_imu.p).norm() > kOpenWay;
}

void Pipeline::warn(Time t, const std::string& kind, const std::string& text) const
{
    if (warn_) warn_({t, kind, text});
}
}  // namespace taut
