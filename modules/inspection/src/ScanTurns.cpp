#include "taut/inspection/ScanTurns.h"

#include "GyroPathPreintegrator.h"
#include "taut/odometry/Pipeline.h"
#include "taut/preintegration/ConstantVelocityPreintegrator.h"

namespace taut
{
namespace
{
constexpr std::size_t kSettling = 5;  // first turns: the map is still of badly undistorted scans

/** Fewer points than the default: hundreds of turns average their noise. */
constexpr char kMethod[] = "features: {voxel_size: 0.3, min_points: 500, max_points: 1000}";

OdometryConfig methodFor(const GyroHint* hint)
{
    ConfigSection root(parseYaml(kMethod));
    OdometryConfig method = OdometryConfig::read(root);
    if (hint)
    {
        const auto path = std::make_shared<GyroPathPreintegrator>();
        path->use(*hint->gyro, hint->clock_offset);
        method.preintegrator = Prototype<Preintegrator>(path);
    }
    else
    {
        method.preintegrator = method.fallback_preintegrator;
    }
    method.fallback_preintegrator = method.preintegrator;
    return method;
}

struct StampedRotation
{
    Time t = 0;
    Matrix3d R_world_lidar;
    bool matched = false;
};
}  // namespace

LidarTurns matchScans(
    const std::vector<Scan>& scans, const GyroHint* hint, Executor& executor,
    const std::function<void(std::size_t)>& done)
{
    const OdometryConfig method = methodFor(hint);
    std::vector<StampedRotation> path;
    const auto collect = [&](const Event& event)
    {
        const auto* estimated = std::get_if<Estimated>(&event);
        if (estimated == nullptr) return;
        const auto& [scan, result] = *estimated;
        // The scan after it knows the end of a sweep better than the sweep itself.
        const Matrix3d& R = scan.T_imu_lidar.R;
        if (!path.empty()) path.back().R_world_lidar = result.previous.T_world_imu.R * R;
        path.push_back(
            {result.estimate.state.t, result.estimate.state.T_world_imu.R * R,
             result.report.lidar_used});
    };
    Pipeline pipeline(method, executor, {}, collect);
    for (std::size_t i = 0; i < scans.size(); i++)
    {
        Scan scan = scans[i];
        if (hint) scan.T_imu_lidar.R = hint->R_imu_lidar;
        pipeline.add(std::move(scan));
        if (done) done(i + 1);
    }
    pipeline.finish();

    LidarTurns turns;
    for (std::size_t k = kSettling; k < path.size(); k++)
        if (path[k - 1].matched && path[k].matched)
            turns.push_back(
                {path[k - 1].t, path[k].t,
                 logSO3(path[k - 1].R_world_lidar.transpose() * path[k].R_world_lidar)});
    return turns;
}
}  // namespace taut
