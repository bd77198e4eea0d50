#include "taut/simulation/Lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "OwnBody.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
constexpr std::size_t kChunk = 2048;
constexpr double kPulseLength = 0.5;        // surfaces closer than this mix [m]
constexpr double kOwnReach = 5;             // of what carries the LiDAR [m]
constexpr float kDropReflectivity = 0.05F;  // of a drop of rain or a grain of dust

std::unique_ptr<LidarPattern> patternOf(const LidarConfig& config)
{
    switch (config.type)
    {
        case LidarType::Vlp16:
            break;
        case LidarType::Hdl32:
            return makeHdl32Pattern(config.rotation_rate);
        case LidarType::Hdl64:
            return makeHdl64Pattern(config.rotation_rate);
        case LidarType::Os1_64:
            return makeOs1Pattern(64, config.rotation_rate);
        case LidarType::Os1_128:
            return makeOs1Pattern(128, config.rotation_rate);
        case LidarType::Rosette:
            return makeRosettePattern(config.rotation_rate);
    }
    return makeVlp16Pattern(config.rotation_rate);
}

/** Light that comes back along a direction, against that of a white wall at 1 m. A ray at the rim
 * of a beam may graze a surface that its middle would see from behind: some light comes back even
 * so. */
double signalOf(const Hit& hit, const Vector3d& direction)
{
    const double cosine = std::max(-hit.normal.dot(direction), 1e-3);
    return hit.reflectivity * cosine / (hit.range * hit.range);
}

/** What a beam of some width measures. Besides its middle, two opposite rays of it are cast. Where
 * all three meet one plane, the middle is what is measured. At an edge, the surfaces that are not
 * told apart by the pulse mix (a range between them, weighted by their light), and of others the
 * brightest counts. */
std::optional<Hit> castBeam(
    const Scene& scene, double t, const Vector3d& origin, const Vector3d& direction,
    const LidarConfig& config, double turn, double radius)
{
    constexpr double flat = 0.01;  // off the plane of the middle [m]
    const auto middle = scene.cast(t, origin, direction, config.max_range);
    if (config.divergence <= 0) return middle;
    const Vector3d u = direction.unitOrthogonal(), v = direction.cross(u);
    const Vector3d aside =
        config.divergence / 2 * radius * (std::cos(turn) * u + std::sin(turn) * v);

    std::array<std::optional<Hit>, 3> hits{middle, {}, {}};
    bool one_plane = middle.has_value();
    for (const int side : {-1, 1})
    {
        const Vector3d ray = (direction + side * aside).normalized();
        auto& hit = hits[side < 0 ? 1 : 2];
        hit = scene.cast(t, origin, ray, config.max_range);
        one_plane =
            one_plane && hit &&
            std::abs(middle->normal.dot(hit->range * ray - middle->range * direction)) < flat;
    }
    if (one_plane) return middle;

    const auto signal = [&](const Hit& h) { return signalOf(h, direction); };
    const std::optional<Hit>* brightest = nullptr;
    for (const auto& h : hits)
        if (h && (!brightest || signal(*h) > signal(**brightest))) brightest = &h;
    if (!brightest) return {};
    double sum = 0, weight = 0;
    for (const auto& h : hits)
        if (h && std::abs(h->range - (*brightest)->range) < kPulseLength)
        {
            sum += signal(*h) * h->range;
            weight += signal(*h);
        }
    Hit mixed = **brightest;
    mixed.range = sum / weight;
    return mixed;
}

/** Part of the shots that come back, by the light received relative to the least that is detected.
 */
double detectionProbability(
    const Hit& hit, const Vector3d& direction, double detection_range, double transmitted)
{
    const double signal =
        signalOf(hit, direction) * detection_range * detection_range * transmitted;
    return 1 / (1 + std::pow(std::max(signal, 1e-3), -4));  // logistic in the logarithm
}
}  // namespace

struct Lidar::Return
{
    LidarPoint point;
    Eigen::Vector3f without_errors;  // its position, sensor frame
    Vector3d surface;                // world frame
};

Lidar::Lidar(const LidarConfig& config, std::uint64_t seed, const WeatherConfig& weather)
    : config_(config),
      weather_(weather),
      seed_(seed),
      pattern_(patternOf(config)),
      beam_errors_(config, pattern_->rings(), seed),
      mount_(config, seed)
{
    Mesh body = makeOwnBody(config.own_body);
    if (!body.triangles.empty()) own_body_.emplace(std::move(body));
}

int Lidar::sweeps(double duration) const
{
    const Duration available = fromSeconds(duration) - kStart;
    return available < 0 ? 0 : static_cast<int>(available / pattern_->period());
}

/** The random numbers of a shot. Drawn whether used or not: what happens to one shot does not
 * change the noise of others. */
struct Lidar::Luck
{
    Luck(Random& random, Random& air, const WeatherConfig& weather)
        : noise(random.normal()),
          detected(random.uniform()),
          lost(random.uniform()),
          turn(random.uniform(0, M_PI)),
          radius(std::sqrt(random.uniform())),
          drop(nearReturn(weather, air))
    {
    }
    double noise, detected, lost, turn, radius;
    std::optional<double> drop;  // its distance [m]
};

std::vector<Lidar::Return> Lidar::castAll(
    const std::vector<Shot>& shots, int k, const Motion& motion, const Scene& scene,
    Executor& executor) const
{
    constexpr std::uint64_t sweeps = 1U << 20U;
    std::vector<std::vector<Return>> parts(Executor::chunks(shots.size(), kChunk));
    const auto cast = [&](std::size_t chunk, std::size_t begin, std::size_t end)
    {
        Random random(seed_, 100 + static_cast<std::uint64_t>(k), chunk);
        Random air(seed_, 33, chunk * sweeps + static_cast<std::uint64_t>(k));
        for (std::size_t i = begin; i < end; i++)
        {
            auto r = measure(shots[i], Luck(random, air, weather_), motion, scene);
            if (!r) continue;
            r->point.offset = static_cast<std::int32_t>(shots[i].t - shots.front().t);
            parts[chunk].push_back(*r);
        }
    };
    executor.forChunks(shots.size(), kChunk, cast);

    std::vector<Return> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::optional<Lidar::Return> Lidar::measure(
    const Shot& shot, const Luck& luck, const Motion& motion, const Scene& scene) const
{
    const double t = toSeconds(kStart + shot.t);
    const Pose T = motion.poseAt(t) * mount_.at(t);
    const Vector3d looking = beam_errors_.looking(shot.direction, shot.ring);
    const Vector3d direction = T.R * looking;
    const Vector3d origin = T * shot.origin;
    auto hit = castBeam(scene, t, origin, direction, config_, luck.turn, luck.radius);
    if (own_body_)
    {
        auto own = own_body_->cast(shot.origin, looking, hit ? hit->range : kOwnReach);
        if (own) own->normal = T.R * own->normal;
        if (own) hit = own;
    }
    const bool by_drop = luck.drop && *luck.drop >= config_.min_range &&
                         *luck.drop < (hit ? hit->range : config_.max_range);
    if (by_drop) hit = Hit{*luck.drop, -direction, kDropReflectivity};
    if (!hit || luck.lost < config_.dropout) return {};
    const double through = transmitted(weather_, hit->range);
    if (config_.detection_range > 0 && !by_drop &&
        luck.detected > detectionProbability(*hit, direction, config_.detection_range, through))
        return {};
    const double cosine = -hit->normal.dot(direction);
    const double light = std::clamp(cosine * hit->reflectivity, 0.0, 1.0) * through;
    const double range = rangeOf(*hit, shot, luck.noise, light, cosine);
    if (range < config_.min_range || range > config_.max_range) return {};

    Return r;
    r.point.position = (shot.origin + range * shot.direction).cast<float>();
    r.point.intensity = static_cast<float>(std::round(255 * light));
    r.point.ring = shot.ring;
    r.without_errors = mount_.corrected(beam_errors_.removed(r.point, shot.origin), t);
    r.surface = origin + hit->range * direction;
    return r;
}

double Lidar::rangeOf(
    const Hit& hit, const Shot& shot, double noise, double light, double cosine) const
{
    double range = hit.range + beam_errors_.range(shot.ring) + config_.range_noise * noise;
    range += config_.intensity_error * (1 - light);
    if (config_.incidence_error != 0)
    {
        const double c = std::clamp(cosine, 1e-3, 1.0);
        const double depth = hit.range * std::sqrt(1 - c * c) / c * config_.divergence;
        range += config_.incidence_error * std::min(depth, kPulseLength) / 2;
    }
    if (config_.range_step > 0) range = config_.range_step * std::round(range / config_.range_step);
    return range;
}

void Lidar::losePackets(std::vector<Return>& returns, int k) const
{
    if (config_.packet_loss.share <= 0) return;
    const Duration packet = pattern_->packet();
    Random random(seed_, 32, static_cast<std::uint64_t>(k));
    const auto packets = static_cast<std::size_t>(pattern_->period() / packet + 2);
    const std::vector<bool> lost = lostPackets(config_.packet_loss, packets, random);
    const auto isLost = [&](const Return& r)
    { return lost[static_cast<std::size_t>(r.point.offset / packet)]; };
    returns.erase(std::remove_if(returns.begin(), returns.end(), isLost), returns.end());
}

Scan Lidar::withoutErrors(Scan recorded, Duration clock) const
{
    recorded = beam_errors_.removed(std::move(recorded));
    for (LidarPoint& p : recorded.points)
        p.position = mount_.corrected(p.position, toSeconds(recorded.timeOf(p) - clock));
    return recorded;
}

SimulatedScan Lidar::sweep(
    int k, const Motion& motion, const Scene& scene, Executor& executor) const
{
    const std::vector<Shot> shots = pattern_->sweep(k);
    std::vector<Return> returns = castAll(shots, k, motion, scene, executor);
    losePackets(returns, k);

    SimulatedScan result;
    Scan& scan = result.scan;
    scan.stamp = kStart + shots.front().t;
    scan.end = scan.stamp;
    scan.rings = pattern_->rings();
    scan.sensor_label = "LIDAR";
    scan.T_imu_lidar = config_.T_imu_lidar;
    for (const Return& r : returns) scan.end = std::max(scan.end, scan.timeOf(r.point));

    Scan ideal = scan;
    for (const Return& r : returns)
    {
        scan.points.push_back(r.point);
        ideal.points.push_back(r.point);
        ideal.points.back().position = r.without_errors;
        result.surface.push_back(r.surface);
    }
    result.truth = undistorted(ideal, motion);
    return result;
}

std::vector<Eigen::Vector3f> undistorted(const Scan& scan, const Motion& motion, Duration clock)
{
    const Pose T_end_world = motion.poseAt(toSeconds(scan.end - clock)).inverse();
    std::vector<Eigen::Vector3f> points;
    points.reserve(scan.points.size());
    for (const LidarPoint& p : scan.points)
    {
        const Pose T_world_imu = motion.poseAt(toSeconds(scan.timeOf(p) - clock));
        const Vector3d in_imu = scan.T_imu_lidar * p.position.cast<double>();
        points.push_back((T_end_world * (T_world_imu * in_imu)).cast<float>());
    }
    return points;
}

// Ranges, noise and widths of the beams are those of the data sheets as far as they tell; the
// detection range is set so that a wall of 10 % is seen as far as the data sheet says, or else by
// analogy.
LidarConfig lidarPreset(LidarType type)
{
    LidarConfig c;
    c.type = type;
    c.dropout = 0.002;
    c.range_step = 0.002;
    switch (type)
    {
        case LidarType::Vlp16:  // 100 m, +-3 cm; beam 3.0 mrad (63-9243)
            c.detection_range = 130;
            c.divergence = 3.0e-3;
            break;
        case LidarType::Hdl32:  // 80 to 100 m, +-2 cm; 2.8 mrad (63-9113)
            c.range_noise = 0.015;
            c.detection_range = 130;
            c.divergence = 2.8e-3;
            break;
        case LidarType::Hdl64:  // 120 m, < 2 cm; 50 m at 10 %; 2.0 mrad (63-HDL64ES2)
            c.max_range = 120;
            c.min_range = 0.9;
            c.range_noise = 0.015;
            c.detection_range = 160;
            c.divergence = 2.0e-3;
            break;
        case LidarType::Os1_64:
        case LidarType::Os1_128:  // 120 m, 45 m at 10 %, +-1.5 to 3 cm; 0.18 degrees (OS1 data
                                  // sheet)
            c.max_range = 120;
            c.range_noise = 0.015;
            c.range_step = 0.001;
            c.detection_range = 145;
            c.divergence = 3.1e-3;
            break;
        case LidarType::Rosette:  // 90 m at 10 %, 2 cm at 20 m; 0.03 x 0.28 degrees (Mid-70 manual)
            c.max_range = 260;
            c.min_range = 0.1;
            c.range_step = 0.001;
            c.detection_range = 285;
            c.divergence = 1.6e-3;  // a circle of the same area
            break;
    }
    return c;
}

void declare(ConfigSection& section, LidarConfig& config)
{
    section.choice<LidarType>(
        "type", config.type,
        {{"VLP-16", LidarType::Vlp16},
         {"HDL-32E", LidarType::Hdl32},
         {"HDL-64E", LidarType::Hdl64},
         {"OS1-64", LidarType::Os1_64},
         {"OS1-128", LidarType::Os1_128},
         {"rosette", LidarType::Rosette}},
        "sensor that the other keys change; rosette = Livox-like");
    config = lidarPreset(config.type);
    section.key("rotation_rate", config.rotation_rate, {1, 30}, "Hz, sweeps a second");
    section.key("min_range", config.min_range, kNotNegative, "m");
    section.key("max_range", config.max_range, kPositive, "m");
    section.key("range_noise", config.range_noise, kNotNegative, "m, standard deviation");
    section.key("range_step", config.range_step, kNotNegative, "m, resolution; 0 = none");
    section.key(
        "detection_range", config.detection_range, kNotNegative,
        "m, where half of the shots at a white wall return; 0 = all");
    section.key("dropout", config.dropout, {0, 1}, "part of the shots lost for no reason");
    section.key(
        "divergence", config.divergence, {0, 0.1}, "rad, full angle of the beam; 0 = a line");
    section.key(
        "beam_error", config.beam_error, {0, 0.1},
        "rad, of the elevation of each ring, standard deviation");
    section.key(
        "beam_range_error", config.beam_range_error, kNotNegative,
        "m, of the ranges of each ring, standard deviation");
    section.key("range_bias", config.range_bias, kAnyNumber, "m, of all ranges; > 0 = too long");
    section.key(
        "intensity_error", config.intensity_error, {-1, 1},
        "m, by which a black surface is measured longer than a white one");
    section.key(
        "incidence_error", config.incidence_error, {-1, 1},
        "part of half the depth of the footprint by which slanting surfaces are measured longer");
    section.choice<OwnBody>(
        "own_body", config.own_body,
        {{"none", OwnBody::None},
         {"person", OwnBody::Person},
         {"car", OwnBody::Car},
         {"multicopter", OwnBody::Multicopter}},
        "what carries the LiDAR and stands in its view");
    declare(section.section("packet_loss"), config.packet_loss);
    declare(section.section("soft_mount"), config.soft_mount);
    // No mount is perfect.
    config.T_imu_lidar =
        declarePose(section.section("mount"), {0.04, -0.03, 0.12}, {0.8, -1.4, 3.0});
    config.mount_error = declarePose(section.section("mount_error"), {0, 0, 0}, {0, 0, 0});
}
}  // namespace taut::simulation
