#include "taut/session/Method.h"

namespace taut
{
Method Method::read(ConfigSection& root, const std::optional<ImuNoise>& noise_of_rig)
{
    if (noise_of_rig)
    {
        root.lay("imu", "gyro_noise", noise_of_rig->gyro);
        root.lay("imu", "accel_noise", noise_of_rig->accel);
        root.lay("imu", "gyro_bias_walk", noise_of_rig->gyro_bias_walk);
        root.lay("imu", "accel_bias_walk", noise_of_rig->accel_bias_walk);
        root.lay("imu", "noise_from_rest", false);
    }
    Method m;
    m.odometry = OdometryConfig::read(root);
    m.slam = SlamConfig::read(root.section("slam"), m.odometry.map);
    ConfigSection& output = root.section("output");
    output.key("refined", m.refined, "write each pose as the next scan leaves it, one scan late");
    output.key(
        "undistorted_points", m.odometry.keep_undistorted,
        "write undistorted.points, for taut-evaluate --points");
    m.map_export.declare(output);
    m.renderer = Prototype<Renderer>(
        createConfigured<Renderer>(root.section("render"), "taut::OSMesaRenderer"));
    root.rejectUnknown();
    m.effective = root.effective();
    return m;
}
}  // namespace taut
