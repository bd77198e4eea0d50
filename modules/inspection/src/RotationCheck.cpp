#include "taut/inspection/RotationCheck.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "taut/core/format.h"
#include "taut/inspection/ImuInspector.h"
#include "taut/inspection/ScanTurns.h"

namespace taut
{
namespace
{
constexpr double kFits = 0.3;          // share of the rotation left over: the path may be believed
constexpr double kFitsAtAll = 0.6;     // more is left over: nothing may be believed
constexpr double kHardlyTurns = 0.05;  // [rad/s] RMS
constexpr double kHardlyRadians = 5;   // [rad/s] RMS: scans would follow even rates in deg/s
constexpr int kMostRounds = 4;
constexpr double kSettledOffset = 1e-3;    // [s] change from round to round
constexpr double kSettledRotation = 1e-2;  // [rad]

constexpr double kOffsetFloor = 1e-4;      // [s] what the jackknife does not see, as measured
constexpr double kRotationFloor = 2e-3;    // [rad]
constexpr double kOffsetKnown = 0.01;      // [s] a worse sigma is no result
constexpr double kRotationKnown = 0.035;   // [rad]
constexpr double kOffsetLimit = 1e-3;      // [s] a smaller offset does no harm
constexpr double kRotationLimit = 0.0175;  // [rad]
constexpr double kSigmas = 4;

constexpr Duration kStep = 100'000'000;
constexpr double kBias = 0.05;  // [rad/s] a gyro at rest may say so much

/** RMS of a gyro's rate without noise and without what may be its bias. */
double rateOf(const ImuSamples& imu)
{
    const GyroRotation gyro(imu);
    double squares = 0, n = 0;
    Vector3d sum = Vector3d::Zero();
    for (Time t = imu.front().t; t + kStep <= imu.back().t; t += kStep)
    {
        const Vector3d rate = gyro.meanRate(t, t + kStep).value_or(Vector3d::Zero());
        squares += rate.squaredNorm();
        sum += rate;
        n++;
    }
    if (n == 0) return 0;
    const double bias = std::min(kBias, (sum / n).norm());
    return std::sqrt(std::max(0.0, squares / n - bias * bias));
}

std::string hardlyTurns(double rate)
{
    return format("the body hardly turns (%.3f rad/s)", rate);
}

class Comparison
{
 public:
    Comparison(
        const std::vector<Scan>& scans, const ImuSamples& imu, Executor& executor,
        const std::function<void(double)>& done)
        : scans_(scans),
          imu_(imu),
          executor_(executor),
          done_(done),
          R_configured_(scans.front().T_imu_lidar.R),
          gyro_(imu)
    {
    }

    /** Nothing if there are too few turns. */
    std::optional<RotationAlignment> run()
    {
        double offset = 0;
        Matrix3d R = R_configured_;
        std::optional<RotationAlignment> best;
        while (rounds_ < kMostRounds)
        {
            const auto found = alongGyro(offset, R);
            if (found && (!best || found->unexplained < best->unexplained)) best = found;
            const bool settled =
                found && std::abs(found->clock_offset - offset) < kSettledOffset &&
                logSO3(found->R_imu_lidar.transpose() * R).norm() < kSettledRotation;
            const bool strange = rounds_ == 1 && rateOf(imu_) > kHardlyRadians;
            if (settled && !strange) return found;
            const bool doubtful = !found || found->unexplained > kFits || strange;
            const auto next = doubtful && rounds_ == 1 ? fromConstantVelocity() : found;
            if (!next) break;
            offset = next->clock_offset;
            R = next->R_imu_lidar;
        }
        return best;
    }

    double factor() const { return factor_; }

 private:
    std::optional<RotationAlignment> alongGyro(double clock_offset, const Matrix3d& R_imu_lidar)
    {
        const GyroHint hint{&gyro_, clock_offset, R_imu_lidar};
        return alignRotations(match(&hint), gyro_, R_configured_);
    }

    /** Also tells the gyro's unit. */
    std::optional<RotationAlignment> fromConstantVelocity()
    {
        const LidarTurns turns = match(nullptr);
        GyroRotation in_degrees(imu_, kDegree);
        const auto rad = alignRotations(turns, gyro_, R_configured_);
        const auto deg = alignRotations(turns, in_degrees, R_configured_);
        if (!deg || (rad && rad->unexplained <= deg->unexplained)) return rad;
        factor_ = kDegree;
        gyro_ = std::move(in_degrees);
        return deg;
    }

    LidarTurns match(const GyroHint* hint)
    {
        rounds_++;
        return matchScans(
            scans_, hint, executor_,
            [this](std::size_t scans)
            {
                const double share =
                    static_cast<double>(scans) / static_cast<double>(scans_.size());
                if (done_) done_((rounds_ - 1 + share) / kMostRounds);
            });
    }

    const std::vector<Scan>& scans_;
    const ImuSamples& imu_;
    Executor& executor_;
    const std::function<void(double)>& done_;
    const Matrix3d R_configured_;
    GyroRotation gyro_;
    double factor_ = 1;
    int rounds_ = 0;
};

void judgeRotation(const Matrix3d& R_configured, RotationFacts& facts)
{
    const RotationAlignment& a = facts.alignment;
    const Matrix3d P = a.R_covariance + kRotationFloor * kRotationFloor * Matrix3d::Identity();
    const Vector3d deviation = logSO3(R_configured.transpose() * a.R_imu_lidar);
    facts.angle = deviation.norm();
    const Vector3d axis =
        facts.angle > 1e-9 ? Vector3d(deviation / facts.angle) : Vector3d::UnitX();
    facts.angle_sigma = 1 / std::sqrt(axis.dot(P.inverse() * axis));
    facts.worst_sigma = std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(P, Eigen::EigenvaluesOnly)
                                      .eigenvalues()
                                      .maxCoeff());
    facts.rotation_known = facts.worst_sigma < kRotationKnown;
}
}  // namespace

RotationFacts compareRotations(
    const std::vector<Scan>& scans, const ImuSamples& imu, Executor& executor,
    const std::function<void(double)>& done)
{
    RotationFacts facts;
    if (scans.empty() || imu.empty())
    {
        facts.not_estimated = "there are no scans and samples at the same time";
        return facts;
    }
    facts.begin = scans.front().stamp;
    facts.end = scans.back().end;
    if (const double rate = rateOf(imu); rate < kHardlyTurns)  // in degrees, it turns even less
    {
        facts.not_estimated = hardlyTurns(rate);
        return facts;
    }
    Comparison comparison(scans, imu, executor, done);
    const auto alignment = comparison.run();
    if (!alignment)
    {
        facts.not_estimated = "too few scans could be matched within the IMU's samples";
        return facts;
    }
    facts.alignment = *alignment;
    facts.gyro_factor = comparison.factor();
    RotationAlignment& a = facts.alignment;
    a.clock_sigma = std::hypot(a.clock_sigma, kOffsetFloor);
    judgeRotation(scans.front().T_imu_lidar.R, facts);
    if (a.gyro_rate < kHardlyTurns)
        facts.not_estimated = hardlyTurns(a.gyro_rate);
    else if (a.unexplained > kFitsAtAll)
        facts.not_estimated = "the rotation from scan matching does not follow the gyro";
    const bool fits = facts.not_estimated.empty();
    facts.offset_known = fits && a.clock_sigma < kOffsetKnown;
    facts.rotation_known = facts.rotation_known && fits;
    return facts;
}

Findings findingsOf(const RotationFacts& f)
{
    Findings found;
    const RotationAlignment& a = f.alignment;
    if (!f.not_estimated.empty())
    {
        if (a.gyro_rate >= kHardlyTurns && a.unexplained > kFitsAtAll)
            found.push_back(
                {f.begin, "rotation_mismatch", 100 * a.unexplained, "%", 1,
                 f.not_estimated + format(": %.0f %% of it is left over", 100 * a.unexplained),
                 "clocks apart by half a second or more, a wrong axis of the gyro, or a place with "
                 "too few surfaces to match"});
        return found;
    }
    if (f.offset_known &&
        std::abs(a.clock_offset) > std::max(kOffsetLimit, kSigmas * a.clock_sigma))
        found.push_back(
            {f.begin, "clock_offset", a.clock_offset, "s", 1,
             format(
                 "the IMU's clock is %.2f ms %s the LiDAR's (+- %.2f ms)",
                 1e3 * std::abs(a.clock_offset), a.clock_offset > 0 ? "ahead of" : "behind",
                 1e3 * a.clock_sigma),
             format(
                 "synchronise the clocks, or set lidar.clock_offset: %.5f in the rig file",
                 f.applied_offset + a.clock_offset)});
    if (f.angle > std::max(kRotationLimit, kSigmas * f.angle_sigma))
    {
        const Matrix3d& R = a.R_imu_lidar;
        const double yaw = std::atan2(R(1, 0), R(0, 0)), pitch = std::asin(-R(2, 0)),
                     roll = std::atan2(R(2, 1), R(2, 2));
        found.push_back(
            {f.begin, "extrinsic_rotation", f.angle / kDegree, "deg", 1,
             format(
                 "the LiDAR is mounted %.2f deg (+- %.2f deg) away from its configured pose",
                 f.angle / kDegree, f.angle_sigma / kDegree),
             format(
                 "check the pose of the LiDAR; relative to the IMU, yaw %.2f, pitch %.2f, roll "
                 "%.2f "
                 "deg fits better",
                 yaw / kDegree, pitch / kDegree, roll / kDegree)});
    }
    return found;
}
}  // namespace taut
