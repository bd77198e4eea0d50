#include "taut/slam/PathCorrection.h"

#include <Eigen/Cholesky>

namespace taut
{
namespace
{
/** Exp(d) of an error on the left: {Exp(theta), p}. */
Pose exponential(const Vector6d& d)
{
    return {expSO3(d.tail<3>()), d.head<3>()};
}

/** d with Exp(d) T = other. */
Vector6d leftErrorTo(const Pose& T, const Pose& other)
{
    const Pose moved = other * T.inverse();
    Vector6d d;
    d << moved.p, logSO3(moved.R);
    return d;
}
}  // namespace

std::vector<Pose> correctedPoses(const Submap& submap, const Pose& T_world_submap)
{
    std::vector<Pose> poses;
    poses.reserve(submap.scans.size());
    for (const SubmapScan& scan : submap.scans) poses.push_back(T_world_submap * scan.T_submap_imu);
    return poses;
}

std::vector<Pose> correctedPoses(
    const Submap& submap, const Pose& T_world_submap, const Pose& T_submap_next,
    const Pose& T_world_next)
{
    const Vector6d gap = leftErrorTo(T_submap_next, T_world_submap.inverse() * T_world_next);
    const Vector6d weighed = submap.last().covariance.ldlt().solve(gap);
    std::vector<Pose> poses;
    poses.reserve(submap.scans.size());
    for (const SubmapScan& scan : submap.scans)
        poses.push_back(
            T_world_submap * exponential(scan.covariance * weighed) * scan.T_submap_imu);
    return poses;
}
}  // namespace taut
