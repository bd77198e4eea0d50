#include "taut/trajectory/Interpolation.h"

#include <algorithm>

namespace taut
{
Pose interpolate(const Pose& a, const Pose& b, double s)
{
    return {a.R * expSO3(s * logSO3(a.R.transpose() * b.R)), a.p + s * (b.p - a.p)};
}

TrajectoryInterpolator::TrajectoryInterpolator(const Trajectory& trajectory, Duration max_gap)
    : trajectory_(trajectory), max_gap_(max_gap > 0 ? max_gap : 3 * medianSpacing(trajectory))
{
    requireIncreasing(trajectory);
}

std::optional<Pose> TrajectoryInterpolator::at(Time t) const
{
    const auto later = std::lower_bound(
        trajectory_.begin(), trajectory_.end(), t,
        [](const StampedPose& pose, Time time) { return pose.t < time; });
    if (later == trajectory_.end()) return {};
    if (later->t == t) return later->T_world_imu;
    if (later == trajectory_.begin()) return {};
    const auto earlier = std::prev(later);
    const Duration spacing = later->t - earlier->t;
    if (spacing > max_gap_) return {};
    const double s = static_cast<double>(t - earlier->t) / static_cast<double>(spacing);
    return interpolate(earlier->T_world_imu, later->T_world_imu, s);
}
}  // namespace taut
