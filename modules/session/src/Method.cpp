#include "taut/session/Method.h"

namespace taut
{
Method Method::read(ConfigSection& root, const std::optional<ImuNoise>& noise_of_rig)
{
    Method m;
    m.odometry = OdometryConfig::read(root);
    if (noise_of_rig)
    {
        m.odometry.imu_noise = *noise_of_rig;
        m.odometry.imu_noise_from_rest = false;
    }
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
