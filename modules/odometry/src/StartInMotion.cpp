#include "StartInMotion.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace taut
{
namespace
{
constexpr double kSettledVelocity = 0.02;  // [m/s] is negligible
constexpr double kSettledTilt = 0.003;     // [rad]
constexpr double kSharpestVelocity = 0.1;  // [m/s] a revised start is known no better
constexpr double kSharpestTilt = 0.01;     // [rad]
constexpr double kWellMatched = 0.5;       // share of the features

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
            const Motion& m = results[k].motion;
            const double dt = results[k].duration;
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
}  // namespace

double Revision::change() const
{
    return std::max(velocity.norm() / kSettledVelocity, tilt() / kSettledTilt);
}

Revision revisionOf(const std::vector<ScanResult>& results)
{
    Revision revision;
    const Vector3d& assumed = results[0].estimate.state.v_world;
    if (results.size() < kBootstrapScans)
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

NavState revised(NavState x, const Revision& revision)
{
    x.v_world = revision.level * Vector3d(x.v_world + revision.velocity);
    x.T_world_imu.R = revision.level * x.T_world_imu.R;
    return x;
}

NavState::Matrix sharpened(const NavState::Matrix& covariance, const Revision& revision)
{
    NavState::Matrix information = covariance.inverse();
    const auto add = [&](int at, double sigma)
    { information.diagonal().segment<3>(at).array() += 1 / square(sigma); };
    add(NavState::kVelocity, std::max(kSharpestVelocity, revision.velocity.norm()));
    add(NavState::kRotation, std::max(kSharpestTilt, revision.tilt()));
    return information.inverse();
}

double misfitOf(const std::vector<ScanResult>& results)
{
    double cost = 0, matches = 0;
    for (const ScanResult& r : results)
    {
        cost += r.cost;
        if (r.lidar_used) matches += r.correspondences;
    }
    // Scans that match nothing cost nothing, and say nothing.
    return matches > 0 ? cost / square(matches) : std::numeric_limits<double>::infinity();
}

double matchedShareOf(const std::vector<ScanResult>& results)
{
    double matches = 0, features = 0;
    for (std::size_t k = 1; k < results.size(); k++)  // the first has no map
    {
        matches += results[k].correspondences;
        features += results[k].features;
    }
    return features > 0 ? matches / features : 0;
}

bool TriedStart::convincing() const
{
    return change <= 1 && matched > kWellMatched;
}
}  // namespace taut
