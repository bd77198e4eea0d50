// Feed the estimation from your own drivers, sample by sample: here a body at rest in a square room
// stands in for them. Prints the pose after each scan.
#include <cmath>
#include <cstdio>

#include "taut/odometry/Pipeline.h"
#include "taut/odometry/registerAll.h"

using namespace taut;

namespace
{
constexpr Duration kMillisecond = 1'000'000;

/** What a LiDAR with 16 rings sees of a room 10 m wide, 1.5 m above its floor. */
Scan sweepAt(Time begin)
{
    Scan scan;
    scan.stamp = begin;
    scan.end = begin + 100 * kMillisecond;
    scan.rings = 16;
    for (int column = 0; column < 360; column++)
        for (int ring = 0; ring < 16; ring++)
        {
            const double azimuth = column * M_PI / 180, elevation = (2 * ring - 15) * M_PI / 180;
            const Vector3d ray(
                std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation));
            double range = 5 / std::max(std::abs(ray.x()), std::abs(ray.y()));
            if (ray.z() < 0) range = std::min(range, -1.5 / ray.z());
            LidarPoint point;
            point.position = (range * ray).cast<float>();
            point.offset = static_cast<std::int32_t>(column * 100 * kMillisecond / 360);
            point.ring = static_cast<std::uint16_t>(ring);
            scan.points.push_back(point);
        }
    return scan;
}

void print(const Event& event)
{
    const auto* estimated = std::get_if<Estimated>(&event);
    if (estimated == nullptr) return;
    const NavState& x = estimated->result.estimate.state;
    std::printf(
        "%.1f s: %.4f %.4f %.4f m, %d of %d features matched\n", toSeconds(x.t),
        x.T_world_imu.p.x(), x.T_world_imu.p.y(), x.T_world_imu.p.z(),
        estimated->result.report.correspondences, estimated->result.report.features);
}
}  // namespace

int main()
{
    registerAll();
    ConfigSection defaults;
    OdometryConfig config = OdometryConfig::read(defaults);
    config.initialization.rest_duration = 1;
    Executor executor(2);
    Pipeline pipeline(
        config, executor,
        [](const Warning& w) { std::printf("%s: %s\n", w.kind.c_str(), w.text.c_str()); }, print);
    for (Time t = 0; t < 3000 * kMillisecond; t += 5 * kMillisecond)
    {
        pipeline.add(ImuSample{t, Vector3d::Zero(), kGravityWorld});
        if (t > 0 && t % (100 * kMillisecond) == 0) pipeline.add(sweepAt(t - 100 * kMillisecond));
    }
    pipeline.finish();
}
