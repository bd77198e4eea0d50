#include "taut/odometry/PoseSearch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr std::size_t kPoints = 150;

// Steps that leave an iteration in reach of the optimum: half of them is less than what the map
// matches, for points near the body.
constexpr double kStep = 0.7;      // [m]
constexpr double kYawStep = 0.14;  // [rad]
constexpr double kNear = 0.2;      // [m] that a point is off its surface: half explained

// What a body may do without being measured.
constexpr double kAcceleration = 2;  // [m/s^2]
constexpr double kFurthest = 5;      // [m] from where its velocity takes it
constexpr double kLongestWay = 40;   // [m] on which it is looked for
constexpr double kRate = 1;          // [rad/s]
constexpr double kMostTurned = 1.2;  // [rad]

/** A rotation levelled: the vector in the body frame points up, the heading is kept. */
Matrix3d levelledKeepingHeading(const Matrix3d& R, const Vector3d& up_body)
{
    const Vector3d up = R * up_body;
    if (up.norm() < 1) return R;  // free fall tells nothing
    return Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix() * R;
}

/** Values from one to the other, about a step apart, the middle among them. */
std::vector<double> steps(double from, double to, double step)
{
    const int half = static_cast<int>(std::ceil((to - from) / (2 * step)));
    std::vector<double> values;
    for (int i = -half; i <= half; i++)
        values.push_back((from + to) / 2 + (half > 0 ? i * (to - from) / (2 * half) : 0.0));
    return values;
}
}  // namespace

PoseSearch::PoseSearch(const std::vector<MapPoint>& scan, const Map& map, Executor& executor)
    : map_(map), executor_(executor)
{
    const std::size_t stride = std::max<std::size_t>(1, scan.size() / kPoints);
    for (std::size_t i = 0; i < scan.size(); i += stride) scan_.push_back(scan[i]);
}

std::vector<Pose> PoseSearch::posesAfter(
    double gap, const NavState& before, const Vector3d& specific_force)
{
    const Pose& from = before.T_world_imu;
    const double reach = std::min(0.5 * kAcceleration * gap * gap, kFurthest);
    const double most_turned = std::min(kRate * gap, kMostTurned);
    const Vector3d level(before.v_world.x(), before.v_world.y(), 0);
    const double length = std::min(level.norm() * gap, kLongestWay);
    const double climb = std::clamp(before.v_world.z() * gap, -kFurthest, kFurthest);
    const Vector3d along = length > 1e-6 ? level.normalized() : Vector3d::UnitX();
    const Vector3d beside = Vector3d::UnitZ().cross(along);
    std::vector<Pose> poses;
    for (const double a : steps(-reach, length + reach, kStep))
        for (const double b : steps(-reach, reach, kStep))
        {
            if (std::hypot(std::max({0.0, -a, a - length}), b) > reach) continue;
            const double share = length > 0 ? std::clamp(a / length, 0.0, 1.0) : 1.0;
            const Vector3d p = from.p + a * along + b * beside + share * climb * Vector3d::UnitZ();
            for (const Matrix3d& R : {from.R, levelledKeepingHeading(from.R, specific_force)})
                for (const double yaw : steps(-most_turned, most_turned, kYawStep))
                    poses.push_back({expSO3({0, 0, yaw}) * R, p});
        }
    return poses;
}

double PoseSearch::inlierWeight(const Pose& T_world_imu)
{
    std::vector<MapPoint> queries = scan_;
    for (MapPoint& q : queries)
    {
        q.position = T_world_imu * q.position;
        q.view = T_world_imu.R * q.view;
    }
    std::vector<Correspondence> found;
    map_.match(queries, found, scratch_, executor_);
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); i++)
    {
        const Correspondence& c = found[i];
        if (c.surface == Surface::None) continue;
        const Vector3d d = queries[i].position - c.point;
        const double along = c.direction.dot(d);
        const double r2 =
            c.surface == Surface::Plane ? along * along : d.squaredNorm() - along * along;
        sum += 1 / (1 + r2 / square(kNear));
    }
    return sum;
}

std::vector<Pose> PoseSearch::bestOf(const std::vector<Pose>& poses, std::size_t count)
{
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < poses.size(); i++) ranked.emplace_back(-inlierWeight(poses[i]), i);
    std::sort(ranked.begin(), ranked.end());
    std::vector<Pose> best;
    for (const auto& [score, i] : ranked)
    {
        if (best.size() == count) break;
        const Pose& pose = poses[i];
        const bool known = std::any_of(
            best.begin(), best.end(),
            [&](const Pose& b)
            {
                return (b.p - pose.p).norm() < 1.1 * kStep &&
                       logSO3(b.R.transpose() * pose.R).norm() < 1.1 * kYawStep;
            });
        if (!known) best.push_back(pose);
    }
    return best;
}
}  // namespace taut
