#include "StartInMotion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace taut
{
namespace
{
constexpr double kNegligibleVelocity = 0.02;  // [m/s] is negligible
constexpr double kNegligibleTilt = 0.003;     // [rad]
constexpr double kLeastVelocitySigma = 0.1;   // [m/s] a revised start is known no better
constexpr double kLeastTiltSigma = 0.01;      // [rad]
constexpr double kWellMatched = 0.5;          // share of the features

// Passes over the first scans, and what of their outcome is worth a warning.
constexpr int kPasses = 12;
constexpr double kStillChanging = 20;  // changes that are negligible
constexpr double kWrongGravity = 1.0;  // [m/s^2] off what it is on Earth
constexpr double kWorse = 1.3;         // misfit of a pass to that of the one before
constexpr double kNoBetter = 0.5;      // change by a pass to that by the one before

// Where else to begin: a vehicle's speed along each horizontal axis of the body.
constexpr double kOtherSpeed = 10;  // [m/s]
const Vector3d kOtherStarts[] = {
    Vector3d::UnitX(), -Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitY()};

/** What the body did when the first scan ended, in the world frame of the results. */
struct StartOfMotion
{
    Vector3d velocity, gravity;
};

/** From the LiDAR's poses and the IMU's integrals: the positions are p_0 + v_0 t + (double integral
 * of R a) - 1/2 g t^2, linear in p_0, v_0 and g. */
StartOfMotion startOfMotion(const std::vector<ScanResult>& results)
{
    // The pose after the next scan is better than the one before it.
    const auto poseOf = [&](std::size_t k)
    {
        return k + 1 < results.size() ? results[k + 1].previous.T_world_imu
                                      : results[k].estimate.state.T_world_imu;
    };
    Matrix3d normal = Matrix3d::Zero();
    Matrix3d right = Matrix3d::Zero();
    Vector3d single = Vector3d::Zero(), twice = Vector3d::Zero();  // integrals of R a
    double t = 0;
    for (std::size_t k = 0; k < results.size(); k++)
    {
        if (k > 0)
        {
            const Matrix3d R = poseOf(k).R;
            const PreintegratedImu& chain = results[k].sweep.motion;
            const Motion& m = chain.knots.back().delta;
            const double dt = chain.duration();
            twice += single * dt - R * (m.beta * dt + m.alpha);
            single -= R * m.beta;
            t += dt;
        }
        const Vector3d row(1, t, -0.5 * t * t);
        normal += row * row.transpose();
        right += row * (poseOf(k).p - twice).transpose();
    }
    const Matrix3d solution = normal.ldlt().solve(right);
    return {solution.row(1).transpose(), solution.row(2).transpose()};
}

/** What the first scans say of the start that they were given. */
struct Revision
{
    Vector3d velocity = Vector3d::Zero();                       // [m/s] is missing
    Eigen::Quaterniond level = Eigen::Quaterniond::Identity();  // turns gravity upright
    double gravity_error = 0;                                   // [m/s^2] of its norm

    double tilt() const { return Eigen::AngleAxisd(level).angle(); }  // [rad]

    /** Its size in what is negligible: at most 1 when map and motion agree. */
    double change() const
    {
        return std::max(velocity.norm() / kNegligibleVelocity, tilt() / kNegligibleTilt);
    }
};

/** Compares the results of the first scans, at least two, with the start they were given. */
Revision revisionOf(const std::vector<ScanResult>& results)
{
    Revision revision;
    const Vector3d& assumed = results[0].estimate.state.v_world;
    if (results.size() < kStartingScans)
    {
        revision.velocity = results[1].previous.v_world - assumed;
        return revision;
    }
    const StartOfMotion seen = startOfMotion(results);
    revision.velocity = seen.velocity - assumed;
    // Without an IMU, level is what the first scan says, and its "gravity" is acceleration.
    if (!results[0].with_imu) return revision;
    revision.level = Eigen::Quaterniond::FromTwoVectors(seen.gravity, kGravityWorld);
    revision.gravity_error = std::abs(seen.gravity.norm() - kGravityWorld.norm());
    return revision;
}

/** The start with that revision. */
NavState revised(NavState x, const Revision& revision)
{
    x.v_world = revision.level * Vector3d(x.v_world + revision.velocity);
    x.T_world_imu.R = revision.level * x.T_world_imu.R;
    return x;
}

/** The covariance of a start that is known as well as it was revised. */
NavState::Matrix posteriorCovariance(const NavState::Matrix& covariance, const Revision& revision)
{
    NavState::Matrix information = covariance.inverse();
    const auto add = [&](int at, double sigma)
    { information.diagonal().segment<3>(at).array() += 1 / square(sigma); };
    add(NavState::kVelocity, std::max(kLeastVelocitySigma, revision.velocity.norm()));
    add(NavState::kRotation, std::max(kLeastTiltSigma, revision.tilt()));
    return information.inverse();
}

/** How badly the scans fit the map that they make: by the cost of a match, and if matches are few.
 */
double misfitOf(const std::vector<ScanResult>& results)
{
    double cost = 0, matches = 0;
    for (const ScanResult& r : results)
    {
        cost += r.report.cost;
        if (r.report.lidar_used) matches += r.report.correspondences;
    }
    // Scans that match nothing cost nothing, and say nothing.
    return matches > 0 ? cost / square(matches) : std::numeric_limits<double>::infinity();
}

/** Share of the features that found a match, over the scans that had a map to match: 0...1. */
double matchedShareOf(const std::vector<ScanResult>& results)
{
    double matches = 0, features = 0;
    for (std::size_t k = 1; k < results.size(); k++)  // the first has no map
    {
        matches += results[k].report.correspondences;
        features += results[k].report.features;
    }
    return features > 0 ? matches / features : 0;
}

/** A start after passes over the first scans, and how its best pass went. */
struct TriedStart
{
    Initialization start;
    double cost = std::numeric_limits<double>::infinity();  // misfit times change; 0 is best
    double change = 0;                                      // by that pass, in what is negligible
    double gravity_error = 0;                               // [m/s^2] seen by that pass
    double matched = 1;                                     // share of the features

    /** Map and motion agree, and with most of what the scans see: not by chance. */
    bool convincing() const { return change <= 1 && matched > kWellMatched; }
};

/** Passes over the first scans from one start, each with what the one before it told. */
TriedStart refine(const Initialization& initialization, const FirstScans& first_scans)
{
    // The start of each pass is as well known as it still changes.
    Initialization start = initialization, widened = start;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double last_misfit = kUnknown, last_change = kUnknown;
    TriedStart best;
    best.start = initialization;
    bool narrow = true;
    for (int pass = 0; pass < kPasses; pass++)
    {
        const std::vector<ScanResult> results = first_scans(start);
        if (results.size() < 2) break;
        const Revision revision = revisionOf(results);
        const double misfit = misfitOf(results);
        if (narrow && misfit > kWorse * last_misfit && revision.change() > kNoBetter * last_change)
        {
            // Known too well too early, false matches agree with each other.
            narrow = false;
            start = widened;
            continue;
        }
        last_misfit = misfit;
        last_change = revision.change();
        const double cost = misfit * std::max(1.0, revision.change());
        if (cost < best.cost)
            best = {
                start, cost, revision.change(), revision.gravity_error, matchedShareOf(results)};
        if (revision.change() <= 1) break;
        widened.estimate.state = revised(start.estimate.state, revision);
        start = widened;
        if (narrow)
            start.estimate.covariance = posteriorCovariance(widened.estimate.covariance, revision);
    }
    return best;
}
}  // namespace

StartInMotion findStartInMotion(const Initialization& initialization, const FirstScans& first_scans)
{
    TriedStart best = refine(initialization, first_scans);
    // False matches hold a start near the velocity that it began with: where few of the features
    // match, or the passes do not converge, others may agree with more of what the scans see.
    if (!best.convincing())
    {
        for (const Vector3d& direction : kOtherStarts)
        {
            Initialization other = initialization;
            NavState& x = other.estimate.state;
            x.v_world += x.T_world_imu.R * Vector3d(kOtherSpeed * direction);
            const TriedStart tried = refine(other, first_scans);
            if (tried.cost < best.cost) best = tried;
        }
    }
    return {best.start, best.change <= kStillChanging && best.gravity_error <= kWrongGravity};
}
}  // namespace taut
