#include "taut/simulation/MotionGenerator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
constexpr double kGravity = 9.81;
constexpr double kRamp = 2.0;        // from rest to full motion [s]
constexpr double kSmoothing = 0.25;  // width of one pass [s]

std::size_t halfWindow(double spacing)
{
    return static_cast<std::size_t>(kSmoothing / spacing / 2);
}

/** 0 before 0, 1 after 1, three times continuously differentiable. */
double smoothStep(double x)
{
    x = std::clamp(x, 0.0, 1.0);
    return x * x * x * x * (35 + x * (-84 + x * (70 - 20 * x)));
}

/** A sum of sinusoids with a peak of about 1; higher ones are weaker, so that all share the speed.
 */
class Wandering
{
 public:
    explicit Wandering(Random& random)
    {
        double sum = 0;
        for (Wave& w : waves_)
        {
            w.frequency = random.uniform(0.35, 1.0);
            w.phase = random.uniform(0, 2 * M_PI);
            w.amplitude = 1 / w.frequency;
            sum += w.amplitude;
        }
        for (Wave& w : waves_) w.amplitude /= 0.75 * sum;
    }
    double at(double cycles) const
    {
        double v = 0;
        for (const Wave& w : waves_)
            v += w.amplitude * std::sin(2 * M_PI * w.frequency * cycles + w.phase);
        return v;
    }

 private:
    struct Wave
    {
        double frequency, phase, amplitude;
    };
    std::array<Wave, 4> waves_{};
};

/** Everything but the shaking: made once. */
struct Base
{
    std::vector<Vector3d> positions;  // of the control points
    std::vector<Matrix3d> rotations;
    std::vector<double> envelope;  // 0 at rest, 1 in full motion
};

/** Rotation that leans body z towards g + lean * a. */
Matrix3d leaning(const Vector3d& acceleration, double lean)
{
    Vector3d up = Vector3d(0, 0, kGravity) + lean * acceleration;
    up.normalize();
    return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), up).toRotationMatrix();
}

/** Vertical and sideways movement of somebody who walks: two steps a cycle sideways, and the
 * harmonics of heels that hit the ground. */
Vector3d stepping(const MotionConfig& config, double t)
{
    const double phase = 2 * M_PI * config.step_frequency * t, h = config.step_height;
    const double up = h * (-std::cos(phase) + 0.12 * std::cos(3 * phase + 0.7) +
                           0.04 * std::cos(5 * phase + 1.9));
    return {0.15 * h * std::sin(phase), 0.8 * h * std::sin(phase / 2), up};
}

/** Where the route leads the body, without sway: smooth enough to be derived twice. */
std::vector<Vector3d> guided(const Course& course)
{
    std::vector<Vector3d> positions;
    for (const double s : course.lengths) positions.push_back(course.path.position(s));
    return smoothed(positions, halfWindow(course.spacing), false);
}

std::vector<Matrix3d> headings(const Course& course)
{
    std::vector<double> angles;
    for (const double s : course.lengths) angles.push_back(course.path.heading(s));
    angles = smoothed(angles, halfWindow(course.spacing), false);
    std::vector<Matrix3d> rotations;
    for (const double angle : angles) rotations.push_back(expSO3(Vector3d(0, 0, angle)));
    return rotations;
}

void leanInto(
    std::vector<Matrix3d>& rotations, const std::vector<Vector3d>& path, double h, double lean)
{
    std::vector<Vector3d> a(path.size(), Vector3d::Zero());
    for (std::size_t i = 1; i + 1 < path.size(); i++)
        a[i] = (path[i + 1] - 2 * path[i] + path[i - 1]) / (h * h);
    a = smoothed(a, halfWindow(h), false);
    for (std::size_t i = 0; i < path.size(); i++) rotations[i] = leaning(a[i], lean) * rotations[i];
}

Base makeBase(const MotionConfig& config, const Course& course, Random& random)
{
    Base base;
    const std::vector<Vector3d> path = guided(course);
    base.rotations = headings(course);
    std::array<Wandering, 3> sway{Wandering(random), Wandering(random), Wandering(random)};
    for (std::size_t i = 0; i < path.size(); i++)
    {
        const double t = course.times[i], since = t - course.departure;
        const double on = smoothStep(since / kRamp);
        base.envelope.push_back(on);
        Vector3d p = stepping(config, since);
        for (int axis = 0; axis < 3; axis++)
            p[axis] += config.sway * sway[axis].at(config.sway_frequency * t);
        // The climb starts at the bottom of its wave: at full height of the route, without a jump.
        const double climb =
            config.climb * (1 - std::cos(2 * M_PI * std::max(0.0, since) / config.climb_period));
        base.positions.emplace_back(
            path[i] + base.rotations[i] * (on * p) + Vector3d(0, 0, config.height + on * climb));
    }
    if (config.lean != 0) leanInto(base.rotations, path, course.spacing, config.lean);
    return base;
}

Motion shaken(
    const Course& course, const Base& base, const std::array<Wandering, 3>& waves, double amplitude,
    double frequency)
{
    std::vector<Pose> controls(course.times.size());
    for (std::size_t i = 0; i < controls.size(); i++)
    {
        const double a = amplitude * base.envelope[i], c = frequency * course.times[i];
        const Matrix3d R = base.rotations[i] * expSO3(Vector3d(0, 0, a * waves[2].at(c))) *
                           expSO3(Vector3d(0, a * waves[1].at(c), 0)) *
                           expSO3(Vector3d(a * waves[0].at(c), 0, 0));
        controls[i] = {R, base.positions[i]};
    }
    return alongCourse(course, controls);
}
}  // namespace

MotionPeaks peaksOf(const Motion& motion)
{
    MotionPeaks peaks;
    constexpr double step = 0.005;
    for (double t = 0; t <= motion.duration(); t += step)
    {
        const MotionState s = motion.at(t);
        peaks.rate = std::max(peaks.rate, s.rate.norm());
        peaks.angular_acceleration =
            std::max(peaks.angular_acceleration, s.angular_acceleration.norm());
        peaks.speed = std::max(peaks.speed, s.v_world.norm());
        peaks.acceleration = std::max(peaks.acceleration, s.a_world.norm());
    }
    return peaks;
}

Motion alongCourse(const Course& course, const std::vector<Pose>& controls)
{
    std::vector<Pose> used;
    for (std::size_t i = 0; i < controls.size(); i++)
    {
        if (course.times[i] < -(Motion::kLead + 0.5) * course.spacing) continue;  // the run-up
        if (course.times[i] >
            course.times.back() - Course::kRunOut + Motion::kLead * course.spacing)
            break;
        used.push_back(controls[i]);
    }
    return {used, course.spacing};
}

Course makeCourse(const MotionConfig& config, const Route& route, double duration, double rest)
{
    return {route, config.limits, config.start, duration, rest, config.knot_spacing};
}

Motion makeMotion(const MotionConfig& config, const Course& course, std::uint64_t seed)
{
    Random random(seed, 1);
    const Base base = makeBase(config, course, random);
    const std::array<Wandering, 3> waves{Wandering(random), Wandering(random), Wandering(random)};
    if (config.shake_rate <= 0) return shaken(course, base, waves, 0, 0);

    // The amplitude sets the rate, and the frequency the ratio of acceleration and rate; what the
    // route and the leaning add to both is known only from the result.
    double frequency = config.shake_acceleration / config.shake_rate / (2 * M_PI);
    double amplitude = config.shake_rate / (2 * M_PI * frequency) / 2;
    for (int i = 0; i < 10; i++)
    {
        const MotionPeaks peaks = peaksOf(shaken(course, base, waves, amplitude, frequency));
        if (peaks.rate < 1e-6) break;  // the recording ends before the rest does
        const double rate = config.shake_rate / peaks.rate;
        const double acceleration = config.shake_acceleration / peaks.angular_acceleration;
        if (std::abs(rate - 1) < 0.01 && std::abs(acceleration - 1) < 0.01) break;
        const double faster = std::clamp(acceleration / rate, 0.8, 1.25);
        frequency *= faster;
        amplitude *= std::clamp(rate / faster, 0.5, 2.0);
    }
    return shaken(course, base, waves, amplitude, frequency);
}

MotionConfig motionPreset(MotionPreset preset)
{
    MotionConfig c;
    c.type = preset;
    const auto along = [&c](double speed, double acceleration, double lateral, double turn) {
        c.limits = {speed, acceleration, lateral, turn};
    };
    const auto shake = [&c](double rate, double acceleration)
    {
        c.shake_rate = rate;
        c.shake_acceleration = acceleration;
    };
    const auto sway = [&c](double metres, double frequency)
    {
        c.sway = metres;
        c.sway_frequency = frequency;
    };
    switch (preset)
    {
        case MotionPreset::Calm:
            along(0.5, 0.5, 0.5, 0.4);
            sway(0.08, 0.3);
            shake(1, 3);
            break;
        case MotionPreset::Walk:
            along(1.2, 1, 1.5, 1.0);
            sway(0.04, 0.4);
            shake(1.5, 10);
            c.step_frequency = 1.9;
            c.step_height = 0.02;
            break;
        case MotionPreset::Fast:
            along(1.2, 1.5, 1.5, 1.2);
            sway(0.15, 0.8);
            shake(3, 20);
            break;
        case MotionPreset::Violent:
            along(1.0, 1.5, 1.5, 1.2);
            sway(0.25, 1.4);
            shake(8, 75);
            break;
        case MotionPreset::Vehicle:
            c.height = 1.7;
            along(15, 2, 3, 0.7);
            sway(0.015, 1.5);
            shake(0.9, 3);
            c.lean = -0.08;
            break;
        case MotionPreset::Flight:
            c.height = 2.5;
            along(4, 2.5, 3, 1.5);
            sway(0.15, 0.6);
            shake(2.5, 15);
            c.climb = 0.8;
            c.lean = 1;
            break;
        case MotionPreset::Replay:
            break;
    }
    return c;
}

void declare(ConfigSection& section, MotionConfig& config)
{
    section.choice<MotionPreset>(
        "type", config.type,
        {{"calm", MotionPreset::Calm},
         {"walk", MotionPreset::Walk},
         {"fast", MotionPreset::Fast},
         {"violent", MotionPreset::Violent},
         {"vehicle", MotionPreset::Vehicle},
         {"flight", MotionPreset::Flight},
         {"replay", MotionPreset::Replay}},
        "preset that the other keys change");
    config = motionPreset(config.type);
    section.key("knot_spacing", config.knot_spacing, {1e-3, 0.2}, "s, of the spline");
    if (config.type == MotionPreset::Replay)
    {
        declare(section, config.replay);
        return;
    }
    SpeedLimits& limits = config.limits;
    section.key("height", config.height, kAnyNumber, "m, of the body over the route");
    section.key("speed", limits.speed, kPositive, "m/s, along the route");
    section.key("acceleration", limits.acceleration, kPositive, "m/s^2, along the route");
    section.key("lateral_acceleration", limits.lateral_acceleration, kPositive, "m/s^2, in bends");
    section.key("turn_rate", limits.turn_rate, kPositive, "rad/s, in bends");
    section.key("start", config.start, {0, 1}, "place on the route, as a part of its length");
    section.key("sway", config.sway, kNotNegative, "m, peak of the wandering beside the route");
    section.key("sway_frequency", config.sway_frequency, kPositive, "Hz, highest");
    section.key("shake_rate", config.shake_rate, kNotNegative, "rad/s, peak; 0 = no shaking");
    section.key("shake_acceleration", config.shake_acceleration, kPositive, "rad/s^2, peak");
    section.key("step_frequency", config.step_frequency, kNotNegative, "Hz; 0 = no steps");
    section.key("step_height", config.step_height, kNotNegative, "m, half of the up and down");
    section.key("climb", config.climb, kNotNegative, "m, amplitude of slow rising and falling");
    section.key("climb_period", config.climb_period, kPositive, "s");
    section.key("lean", config.lean, {-1, 1}, "1 = thrust along body z, < 0 = on springs");
}
}  // namespace taut::simulation
