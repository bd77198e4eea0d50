#pragma once

#include <optional>

#include "taut/trajectory/Trajectory.h"

namespace taut
{
/** Between two poses: position linear, rotation at constant rate (slerp). s in [0, 1]. */
Pose interpolate(const Pose& a, const Pose& b, double s);

/** A trajectory as a function of time. It never answers outside the stamps, nor inside a gap. */
class TrajectoryInterpolator
{
 public:
    /** Spacings above `max_gap` [ns] are gaps; 0 takes three times the median spacing: a lost pose
     * or two are bridged at any rate, and nothing longer. Keeps a reference: the trajectory must
     * outlive this. Throws std::invalid_argument unless the times increase strictly. */
    explicit TrajectoryInterpolator(const Trajectory& trajectory, Duration max_gap = 0);

    /** T_world_imu at time t, exact at a stamp; nothing outside the stamps or inside a gap. */
    std::optional<Pose> at(Time t) const;

    Duration maxGap() const { return max_gap_; }

 private:
    const Trajectory& trajectory_;
    Duration max_gap_;
};
}  // namespace taut
