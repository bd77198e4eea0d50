#include "taut/simulation/Lidar.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
constexpr std::size_t kChunk = 2048;
constexpr double kDegree = M_PI / 180;

std::unique_ptr<LidarPattern> patternOf(const LidarConfig& config)
{
    return makeVlp16Pattern(config.rotation_rate);
}

/** Part of the shots that come back, by the light received relative to the least that is detected.
 */
double detectionProbability(const Hit& hit, const Vector3d& direction, double detection_range)
{
    const double cosine = -hit.normal.dot(direction);
    const double ratio = detection_range / hit.range;
    const double signal = hit.reflectivity * cosine * ratio * ratio;
    return signal / (signal + 1 / (1e-9 + signal * signal));  // logistic in the logarithm
}
}  // namespace

struct Lidar::Return
{
    LidarPoint point;
    Vector3d body_point;  // measured point in the IMU frame at its time
    Vector3d surface;     // world frame
};

Lidar::Lidar(const LidarConfig& config, std::uint64_t seed)
    : config_(config), seed_(seed), pattern_(patternOf(config))
{
}

int Lidar::sweeps(double duration) const
{
    const Duration available = fromSeconds(duration) - kStart;
    return available < 0 ? 0 : static_cast<int>(available / pattern_->period());
}

std::vector<Lidar::Return> Lidar::castAll(
    const std::vector<Shot>& shots, int k, const Motion& motion, const RayCaster& world,
    Executor& executor) const
{
    std::vector<std::vector<Return>> parts(Executor::chunks(shots.size(), kChunk));
    const auto cast = [&](std::size_t chunk, std::size_t begin, std::size_t end)
    {
        Random random(seed_, 100 + static_cast<std::uint64_t>(k), chunk);
        for (std::size_t i = begin; i < end; i++)
        {
            const Shot& shot = shots[i];
            // Drawn whether used or not: what happens to one shot does not change the noise of
            // others.
            const double noise = random.normal(), luck = random.uniform(), loss = random.uniform();
            const Pose T = motion.poseAt(toSeconds(kStart + shot.t)) * config_.T_imu_lidar;
            const Vector3d direction = T.R * shot.direction;
            const auto hit = world.cast(T.p, direction, config_.max_range);
            if (!hit || loss < config_.dropout) continue;
            if (config_.detection_range > 0 &&
                luck > detectionProbability(*hit, direction, config_.detection_range))
                continue;
            double range = hit->range + config_.range_noise * noise;
            if (config_.range_step > 0)
                range = config_.range_step * std::round(range / config_.range_step);
            if (range < config_.min_range || range > config_.max_range) continue;

            Return r;
            r.point.position = (range * shot.direction).cast<float>();
            r.point.intensity = static_cast<float>(std::round(
                255 * std::clamp(-hit->normal.dot(direction) * hit->reflectivity, 0.0, 1.0)));
            r.point.offset = static_cast<std::int32_t>(shot.t - shots.front().t);
            r.point.ring = shot.ring;
            r.body_point = config_.T_imu_lidar * r.point.position.cast<double>();
            r.surface = T.p + hit->range * direction;
            parts[chunk].push_back(r);
        }
    };
    executor.forChunks(shots.size(), kChunk, cast);

    std::vector<Return> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

SimulatedScan Lidar::sweep(
    int k, const Motion& motion, const RayCaster& world, Executor& executor) const
{
    const std::vector<Shot> shots = pattern_->sweep(k);
    const std::vector<Return> returns = castAll(shots, k, motion, world, executor);

    SimulatedScan result;
    Scan& scan = result.scan;
    scan.stamp = kStart + shots.front().t;
    scan.end = scan.stamp;
    scan.rings = pattern_->rings();
    scan.sensor_label = "LIDAR";
    scan.T_imu_lidar = config_.T_imu_lidar;
    for (const Return& r : returns) scan.end = std::max(scan.end, scan.timeOf(r.point));

    const Pose T_end_world = motion.poseAt(toSeconds(scan.end)).inverse();
    for (const Return& r : returns)
    {
        const Pose T = T_end_world * motion.poseAt(toSeconds(scan.timeOf(r.point)));
        scan.points.push_back(r.point);
        result.truth.push_back((T * r.body_point).cast<float>());
        result.surface.push_back(r.surface);
    }
    return result;
}

LidarConfig lidarPreset(LidarType type)
{
    LidarConfig c;
    c.type = type;
    c.range_step = 0.002;
    c.detection_range = 110;
    c.dropout = 0.002;
    return c;
}

void declare(ConfigSection& section, LidarConfig& config)
{
    section.choice<LidarType>("type", config.type, {{"VLP-16", LidarType::Vlp16}}, "sensor");
    const Pose T_imu_lidar = config.T_imu_lidar;
    config = lidarPreset(config.type);
    config.T_imu_lidar = T_imu_lidar;
    section.key("rotation_rate", config.rotation_rate, {1, 30}, "Hz, sweeps a second");
    section.key("min_range", config.min_range, kNotNegative, "m");
    section.key("max_range", config.max_range, kPositive, "m");
    section.key("range_noise", config.range_noise, kNotNegative, "m, standard deviation");
    section.key("range_step", config.range_step, kNotNegative, "m, resolution; 0 = none");
    section.key(
        "detection_range", config.detection_range, kNotNegative,
        "m, where half of the shots at a white wall return; 0 = all");
    section.key("dropout", config.dropout, {0, 1}, "part of the shots lost for no reason");

    Vector3d angles(0.8, -1.4, 3.0);  // degrees: no mount is perfect
    Vector3d p(0.04, -0.03, 0.12);
    ConfigSection& mount = section.section("mount");
    mount.key("x", p.x(), kAnyNumber, "m, LiDAR in the IMU frame");
    mount.key("y", p.y(), kAnyNumber, "m");
    mount.key("z", p.z(), kAnyNumber, "m");
    mount.key("roll", angles.x(), {-180, 180}, "degrees");
    mount.key("pitch", angles.y(), {-180, 180}, "degrees");
    mount.key("yaw", angles.z(), {-180, 180}, "degrees; applied first yaw, then pitch, then roll");
    config.T_imu_lidar.p = p;
    config.T_imu_lidar.R = expSO3(Vector3d(0, 0, angles.z() * kDegree)) *
                           expSO3(Vector3d(0, angles.y() * kDegree, 0)) *
                           expSO3(Vector3d(angles.x() * kDegree, 0, 0));
}
}  // namespace taut::simulation
