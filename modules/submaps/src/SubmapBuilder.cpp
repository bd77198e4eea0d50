#include "taut/submaps/SubmapBuilder.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "taut/core/Voxel.h"

namespace taut
{
namespace
{
constexpr double kLever = 10;                // [m] at which rotations are compared with positions
constexpr std::size_t kPointsOfScan = 5000;  // looked at for the points of a submap
constexpr std::size_t kRanges = 4096;        // remembered for the median
constexpr std::size_t kMostScans = 65000;    // that SubmapPoint::scan can name

/** Position and heading of a pose. */
Pose levelledFrame(const Pose& T_world_imu)
{
    const Vector3d ahead = T_world_imu.R.col(0);
    // A body whose x axis points up has its heading where its z axis points away from.
    const Vector3d heading = std::hypot(ahead.x(), ahead.y()) > 0.1 ? ahead : -T_world_imu.R.col(2);
    return {expSO3({0, 0, std::atan2(heading.y(), heading.x())}), T_world_imu.p};
}

/** The part of a symmetric matrix that is positive semi-definite. */
Matrix6d positivePart(const Matrix6d& m)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(m);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
           eigen.eigenvectors().transpose();
}

/** Covariance of (p, theta) of a pose in the world frame, both told there. */
Matrix6d poseCovariance(const NavEstimate& e)
{
    constexpr int at[] = {NavState::kPosition, NavState::kRotation};
    Matrix6d body;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            body.block<3, 3>(3 * i, 3 * j) = e.covariance.block<3, 3>(at[i], at[j]);
    Matrix6d to_world = Matrix6d::Identity();
    to_world.bottomRightCorner<3, 3>() = e.state.T_world_imu.R;
    return to_world * body * to_world.transpose();
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}
}  // namespace

void SubmapConfig::declare(ConfigSection& s)
{
    s.key("length_share", length_share, kPositive, "of the median range, length of a submap");
    s.key("min_length", min_length, kPositive, "m, length of a submap");
    s.key("max_length", max_length, kPositive, "m");
    s.key("min_duration", min_duration, kPositive, "s, a shorter submap ends at no length");
    s.key("max_duration", max_duration, kPositive, "s, a submap ends at last");
    s.key("point_spacing", point_spacing, kPositive, "m, one point a voxel of this size");
    s.key("max_points", max_points, {1000, 1e7}, "of a submap; evenly thinned above");
    s.key("key_distance", key_distance, kPositive, "m, or");
    s.key("key_angle", key_angle, kPositive, "rad, from one key scan to the next");
    s.key("drift_position", drift_position, kPositive, "m/m, besides the odometry's covariance");
    s.key("drift_rotation", drift_rotation, kPositive, "rad/m");
    s.key("drift_turn", drift_turn, kPositive, "rad/rad turned");
    s.key("tilt_sigma", tilt_sigma, kPositive, "rad, of up as the odometry knows it, at least");
    s.key("doubt_speed", doubt_speed, kPositive, "m/s, drift while the pose is in doubt");
    s.key("doubt_rate", doubt_rate, kPositive, "rad/s, the same of the rotation");
}

SubmapBuilder::SubmapBuilder(const SubmapConfig& config, std::function<void(Submap)> done)
    : config_(config),
      done_(std::move(done)),
      points_(static_cast<std::size_t>(config.max_points)),
      ranges_(kRanges)
{
}

void SubmapBuilder::start(const NavEstimate& first)
{
    end();
    begin(first);
}

void SubmapBuilder::begin(const NavEstimate& first)
{
    submap_.emplace();
    submap_->id = next_id_++;
    submap_->T_world_submap = levelledFrame(first.state.T_world_imu);
    submap_->path_begin = path_;
    submap_->doubtful = doubtful_;
    const Matrix3d of_tilt = poseCovariance(first).bottomRightCorner<3, 3>();
    const Matrix3d R = submap_->T_world_submap.R;
    submap_->up_covariance = R.transpose() * of_tilt * R +
                             Matrix3d(Vector3d::Constant(square(config_.tilt_sigma)).asDiagonal());
    submap_->scans.push_back(
        {first.state.t, submap_->T_world_submap.inverse() * first.state.T_world_imu,
         Matrix6d::Zero()});
    last_ = first;
    way_ = turned_ = 0;
}

void SubmapBuilder::end()
{
    if (!submap_) return;
    submap_->path_end = path_;
    submap_->points = points_.items();
    submap_->reach = median(ranges_.items());
    voxels_.clear();
    points_ = ThinnedSample<SubmapPoint>(static_cast<std::size_t>(config_.max_points));
    ranges_ = ThinnedSample<double>(kRanges);
    Submap done = std::move(*submap_);
    submap_.reset();
    if (done.scans.size() > 1) done_(std::move(done));
}

void SubmapBuilder::finish()
{
    end();
}

void SubmapBuilder::setDoubt(bool doubtful)
{
    if (doubtful == doubtful_) return;
    doubtful_ = doubtful;
    if (!submap_) return;
    if (submap_->scans.size() == 1)
    {
        submap_->doubtful = doubtful;  // it has only begun
        return;
    }
    end();
    begin(last_);
}

bool SubmapBuilder::isComplete() const
{
    const double duration = toSeconds(last_.state.t - submap_->scans.front().t);
    if (duration >= config_.max_duration || submap_->scans.size() > kMostScans) return true;
    const double length = std::clamp(
        config_.length_share * median(ranges_.items()), config_.min_length, config_.max_length);
    return duration >= config_.min_duration && submap_->last().T_submap_imu.p.norm() >= length;
}

void SubmapBuilder::add(
    const NavEstimate& estimate, const std::vector<Vector3d>& points_world, const Pose& T_imu_lidar)
{
    if (!submap_) begin(estimate);
    const Pose& T_world_imu = estimate.state.T_world_imu;
    const Matrix6d covariance = submap_->last().covariance + stepCovariance(estimate);
    const double step = (T_world_imu.p - last_.state.T_world_imu.p).norm();
    submap_->scans.push_back(
        {estimate.state.t, submap_->T_world_submap.inverse() * T_world_imu, covariance});
    path_ += step;
    way_ += step;
    turned_ += logSO3(last_.state.T_world_imu.R.transpose() * T_world_imu.R).norm();
    last_ = estimate;

    addPoints(points_world);
    const Pose T_world_sensor = T_world_imu * T_imu_lidar;
    const Pose since_key = last_key_.inverse() * T_world_sensor;
    if (submap_->key_scans.empty() || since_key.p.norm() > config_.key_distance ||
        logSO3(since_key.R).norm() > config_.key_angle)
        addKeyScan(points_world, T_world_sensor, step);
    if (!isComplete()) return;
    end();
    begin(estimate);
}

Matrix6d SubmapBuilder::stepCovariance(const NavEstimate& estimate)
{
    const Pose& before = last_.state.T_world_imu;
    const Pose& now = estimate.state.T_world_imu;
    // Information that is lost on the way does not come back: what the filter knows again
    // afterwards, it knows relative to a map that it has built in between.
    Matrix6d scale = Matrix6d::Identity();
    scale.bottomRightCorner<3, 3>() *= kLever;
    const Matrix6d unscale = scale.inverse();
    Matrix6d step =
        unscale * positivePart(scale * (poseCovariance(estimate) - poseCovariance(last_)) * scale) *
        unscale;

    // Errors that do not average out: their deviation grows with the way, so the variance of one
    // step depends on the way before.
    const double way = (now.p - before.p).norm();
    const double angle = logSO3(before.R.transpose() * now.R).norm();
    const auto growth = [](double rate, double so_far, double by)
    { return square(rate) * (square(so_far + by) - square(so_far)); };
    double position = growth(config_.drift_position, way_, way);
    double rotation =
        growth(config_.drift_rotation, way_, way) + growth(config_.drift_turn, turned_, angle);
    if (doubtful_)
    {
        const double dt = toSeconds(estimate.state.t - last_.state.t);
        const double since = toSeconds(last_.state.t - submap_->scans.front().t);
        position += growth(config_.doubt_speed, since, dt);
        rotation += growth(config_.doubt_rate, since, dt);
    }
    step.topLeftCorner<3, 3>().diagonal().array() += position;
    step.bottomRightCorner<3, 3>().diagonal().array() += rotation;

    // From errors of the pose to errors on the left of T_submap_imu.
    const Matrix3d R = submap_->T_world_submap.R.transpose();
    Matrix6d to_left = Matrix6d::Zero();
    to_left.topLeftCorner<3, 3>() = to_left.bottomRightCorner<3, 3>() = R;
    to_left.topRightCorner<3, 3>() = hat(submap_->T_world_submap.inverse() * now.p) * R;
    return to_left * step * to_left.transpose();
}

void SubmapBuilder::addPoints(const std::vector<Vector3d>& points_world)
{
    const Pose T_submap_world = submap_->T_world_submap.inverse();
    const auto scan = static_cast<std::uint16_t>(submap_->scans.size() - 1);
    const double inverse = 1 / config_.point_spacing;
    const std::size_t stride = points_world.size() / kPointsOfScan + 1;
    for (std::size_t i = 0; i < points_world.size(); i += stride)
    {
        const Vector3d p = T_submap_world * points_world[i];
        if (!p.allFinite()) continue;
        ranges_.add((points_world[i] - last_.state.T_world_imu.p).norm());
        if (voxels_.insert(voxelKey(p, inverse))) points_.add({p.cast<float>(), scan});
    }
}

void SubmapBuilder::addKeyScan(
    const std::vector<Vector3d>& points_world, const Pose& T_world_sensor, double blur)
{
    KeyScan key;
    key.scan = static_cast<std::uint16_t>(submap_->scans.size() - 1);
    key.T_submap_sensor = submap_->T_world_submap.inverse() * T_world_sensor;
    key.blur = blur;
    const Pose T_sensor_world = T_world_sensor.inverse();
    for (const Vector3d& p : points_world) key.image.add(T_sensor_world * p);
    submap_->key_scans.push_back(std::move(key));
    last_key_ = T_world_sensor;
}
}  // namespace taut
