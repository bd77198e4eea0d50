#include "taut/odometry/Odometry.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "Registration.h"
#include "Stopwatch.h"
#include "taut/factors/SampledPath.h"

namespace taut
{
namespace
{
// Weight of a scan in what is usual, and that of one that is doubtful.
constexpr double kFitMemory = 0.1;
constexpr double kDoubtMemory = 0.01;
// Fewer features are not left however short the time is.
constexpr std::size_t kFewestFeatures = 200;

/** [rad/s] by which the rate may differ from that of the sweep before the IMU fell silent. */
constexpr double kRateSigma = 2;

std::array<double, 3> eigenvaluesOf(const Matrix3d& information)
{
    const Vector3d e =
        Eigen::SelfAdjointEigenSolver<Matrix3d>(information, Eigen::EigenvaluesOnly).eigenvalues();
    return {e[0], e[1], e[2]};
}

/* A share of the features, evenly over the sweep. */
void keepShare(double share, Features& features)
{
    const std::size_t n = features.points.size();
    const auto wanted = static_cast<std::size_t>(share * static_cast<double>(n));
    const std::size_t kept = std::max(wanted, std::min(n, kFewestFeatures));
    for (std::size_t i = 0; i < kept; i++) features.points[i] = features.points[i * n / kept];
    features.points.resize(kept);
}
}  // namespace

bool isDoubtful(const ScanReport& report)
{
    // While the pose is right the share varies between 0.67 and 1.1 of its mean, in simulated and
    // real recordings. At a place that is not where the map has it, half of the matches are false
    // or more.
    constexpr double kDoubtful = 0.6;
    return report.lidar_used && report.fit() < kDoubtful * report.usual_fit;
}

Odometry::Odometry(const OdometryConfig& config, Executor& executor, WarningSink warn)
    : config_(config),
      preintegrator_(config.preintegrator.create()),
      fallback_preintegrator_(config.fallback_preintegrator.create()),
      extractor_(config.extractor.create()),
      solver_(config.solver.create()),
      map_(config.map.create()),
      executor_(executor),
      warn_(std::move(warn)),
      noise_(config.imu_noise)
{
}

void Odometry::start(const Initialization& initialization)
{
    started_ = true;
    previous_.state = initialization.estimate.state;
    previous_.information =
        initialization.estimate.covariance.ldlt().solve(NavState::Matrix::Identity());
    previous_rate_.setZero();
    rate_is_state_ = false;
    rest_ = Rest(initialization, config_.initialization);
    noise_ = config_.imu_noise;
    if (config_.imu_noise_from_rest && initialization.at_rest)
    {
        noise_.gyro = std::max(noise_.gyro, initialization.measured_noise.gyro);
        noise_.accel = std::max(noise_.accel, initialization.measured_noise.accel);
    }
    usual_inlier_share_ = usual_fit_ = 0;
    map_->clear();
}

PreintegratedImu Odometry::integrate(Time end, const ImuSamples* imu) const
{
    PreintegrationRequest request;
    request.begin = previous_.state.t;
    request.end = end;
    request.samples = imu;
    request.previous = previous_.state;
    request.previous_rate = previous_rate_;
    request.noise = noise_;
    return (imu != nullptr ? preintegrator_ : fallback_preintegrator_)->integrate(request);
}

ScanResult Odometry::process(const Scan& raw, const ImuSamples* imu)
{
    ScanResult result;
    Stopwatch watch;
    const Time begin = previous_.state.t;
    const Scan scan = transformScan(raw, config_.range, begin);
    result.with_imu = imu != nullptr;
    result.report.scan_points = scan.points.size();
    watch.stage(result.report.times.transform);

    if (imu != nullptr && rate_is_state_) takeBiasesBack();
    const PreintegratedImu motion = integrate(scan.end, imu);
    if (motion.rate_walk > 0 && !rate_is_state_) makeRateAState();
    const NavState prior = predict(motion, previous_.state);
    Undistortion mode = config_.estimation.undistortion;
    if (scan.already_undistorted) mode = Undistortion::None;
    // What was not measured in a gap before the sweep is not to be closed in the sweep.
    if (isIterated(mode) && result.with_imu && hasLongGap(motion)) mode = Undistortion::IteratedImu;
    const SweepPath predicted(mode, motion, previous_.state, prior);
    result.sweep.mode = mode;
    result.sweep.T_imu_lidar = raw.T_imu_lidar;
    result.sweep.previous_rate = previous_rate_;
    result.sweep.noise = noise_;
    result.sweep.with_imu = result.with_imu;
    result.sweep.prior_begin = previous_.state;
    result.sweep.prior_end = prior;
    watch.stage(result.report.times.preintegrate);

    Features features = extractor_->extract(scan, warn_);
    if (share_ < 1) keepShare(share_, features);
    result.report.features = static_cast<int>(features.points.size());
    watch.stage(result.report.times.extract);

    const SweepPath path = estimate(features, motion, predicted, result);
    watch.stage(result.report.times.solve);
    result.report.times.solve -= result.report.times.match;

    insert(scan, path, result);
    result.sweep.motion = motion;
    result.sweep.begin = result.previous;
    result.sweep.end = previous_.state;
    watch.stage(result.report.times.insert);
    if (config_.keep_undistorted) result.undistorted = undistorted(raw, begin, path);
    return result;
}

void Odometry::makeRateAState()
{
    rate_is_state_ = true;
    bias_gyro_ = previous_.state.bias_gyro;
    bias_gyro_covariance_ = previous_.covarianceOf(NavState::kBiasGyro);
    previous_.forget(NavState::kBiasGyro, square(kRateSigma) * Matrix3d::Identity());
}

void Odometry::takeBiasesBack()
{
    rate_is_state_ = false;
    previous_.state.bias_gyro = bias_gyro_;
    previous_.forget(NavState::kBiasGyro, bias_gyro_covariance_);
}

SweepPath Odometry::estimate(
    const Features& features, const PreintegratedImu& motion, const SweepPath& predicted,
    ScanResult& result)
{
    Registration registration(
        config_, *map_, *solver_, scratch_, executor_, previous_, motion, features, predicted);
    ScanProblem& problem = registration.problem();
    LidarFactor::PoseCovariance uncertain = problem.predictedPoseCovariance();
    if (result.with_imu && hasLongGap(motion) && !map_->empty())
    {
        uncertain = registration.startAfterGap(usual_inlier_share_);
        rest_ = {};  // nothing says that it rests still
    }
    else
    {
        const double rate = logSO3(motion.knots.back().delta.gamma).norm() / motion.duration();
        problem.setMotionPrior(rest_.at(problem.current(), problem.predictedCovariance(), rate));
    }
    const std::string failure = registration.iterate(uncertain, result.report);
    if (!failure.empty()) throw std::runtime_error(failure);
    result.previous = problem.previous();

    problem.relinearize();
    const NavState::Matrix lidar_information = problem.lidarInformation();
    result.report.translation_information =
        eigenvaluesOf(lidar_information.block<3, 3>(NavState::kPosition, NavState::kPosition));
    result.report.rotation_information =
        eigenvaluesOf(lidar_information.block<3, 3>(NavState::kRotation, NavState::kRotation));

    // The posterior of x_k is the prior of the next scan.
    const NavState::Matrix information = problem.marginalInformation();
    previous_rate_ =
        logSO3(problem.previous().T_world_imu.R.transpose() * problem.current().T_world_imu.R) /
        motion.duration();
    if (rate_is_state_)
        previous_rate_ = motion.knots.front().sample.gyro - problem.current().bias_gyro;
    previous_ = {problem.current(), information};
    result.estimate.state = previous_.state;
    if (rate_is_state_) result.estimate.state.bias_gyro = bias_gyro_;
    result.estimate.covariance = information.ldlt().solve(NavState::Matrix::Identity());
    endRestIfLeft(lidar_information);
    judgeFit(result.report);
    return registration.path();
}

void Odometry::judgeFit(ScanReport& report)
{
    if (!report.lidar_used || !std::isfinite(report.inlier_weight)) return;
    report.usual_fit = usual_fit_;
    const double inlier_share = report.inlier_weight / report.features;
    if (usual_fit_ == 0)
    {
        usual_fit_ = report.fit();
        usual_inlier_share_ = inlier_share;
    }
    const double memory = isDoubtful(report) ? kDoubtMemory : kFitMemory;
    usual_fit_ += memory * (report.fit() - usual_fit_);
    usual_inlier_share_ += memory * (inlier_share - usual_inlier_share_);
}

void Odometry::endRestIfLeft(const NavState::Matrix& lidar_information)
{
    // Steady motion is a rest to the IMU; the LiDAR knows better.
    const auto left = rest_.endIfLeft(previous_.state, lidar_information);
    if (!left || !warn_) return;
    std::ostringstream text;
    text << "the LiDAR moves by " << 1e3 * left->moved << " mm and " << left->turned
         << " rad while the IMU rests";
    warn_({previous_.state.t, "rest_left", text.str()});
}

std::vector<Eigen::Vector3f> Odometry::undistorted(
    const Scan& raw, Time begin, const SweepPath& path) const
{
    const Pose T_end_world = previous_.state.T_world_imu.inverse();
    std::vector<Eigen::Vector3f> points(
        raw.points.size(), Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    executor_.forChunks(
        points.size(), 1024,
        [&](std::size_t, std::size_t chunk_begin, std::size_t chunk_end)
        {
            std::size_t hint = 0;
            for (std::size_t i = chunk_begin; i < chunk_end; i++)
            {
                const LidarPoint& p = raw.points[i];
                if (!isUsable(p, raw, config_.range, begin)) continue;
                const Pose T_end_imu = T_end_world * path.poseAt(raw.timeOf(p), hint);
                const Vector3d in_imu = raw.T_imu_lidar * Vector3d(p.position.cast<double>());
                points[i] = (T_end_imu * in_imu).cast<float>();
            }
        });
    return points;
}

void Odometry::insert(const Scan& scan, const SweepPath& path, ScanResult& result)
{
    map_->keep(scratch_);
    map_->slide(previous_.state.T_world_imu.p);
    if (scan.points.empty()) return;
    Scan& raw = result.sweep.scan;
    auto most = static_cast<std::size_t>(config_.insert.max_points);
    if (share_ < 1)
    {
        const auto n = static_cast<double>(std::min(most, scan.points.size()));
        most = static_cast<std::size_t>(std::max(1.0, std::floor(share_ * n)));
    }
    raw = thinned(scan, most);
    const std::size_t kept = raw.points.size();
    const auto [first, last] = std::minmax_element(
        scan.points.begin(), scan.points.end(),
        [](const LidarPoint& a, const LidarPoint& b) { return a.offset < b.offset; });
    const SampledPath poses(path, scan.timeOf(*first), scan.timeOf(*last));
    inserted_.resize(kept);
    result.points.resize(kept);
    executor_.forChunks(
        kept, 1024,
        [&](std::size_t, std::size_t chunk_begin, std::size_t chunk_end)
        {
            for (std::size_t i = chunk_begin; i < chunk_end; i++)
            {
                const LidarPoint& p = raw.points[i];
                const Pose pose = poses.poseAt(scan.timeOf(p));
                const Vector3d position = pose * Vector3d(p.position.cast<double>());
                inserted_[i] = {position, FeatureKind::Any, (pose.p - position).normalized()};
                result.points[i] = position;
            }
        });
    map_->insert(inserted_, executor_);
}
}  // namespace taut
