#include "taut/simulation/ImuModel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
namespace
{
const Vector3d kGravity(0, 0, 9.81);
constexpr Duration kTick = 100;  // of the stamps in rawlogs [ns]

/** Nodes on (-1, 1) and weights (their sum is 1) of Gauss and Legendre's rule with three points. */
constexpr std::array<std::pair<double, double>, 3> kNodes{
    {{-0.7745966692414834, 5.0 / 18}, {0.0, 8.0 / 18}, {0.7745966692414834, 5.0 / 18}}};

/** Mean over an interval of the readings of a perfect IMU. */
ImuSample meanImu(const Motion& motion, double middle, double width)
{
    ImuSample mean;
    for (const auto& [node, weight] : kNodes)
    {
        const ImuSample s = trueImu(motion.at(middle + node * width / 2));
        mean.gyro += weight * s.gyro;
        mean.accel += weight * s.accel;
    }
    return mean;
}

/** Scale errors and misalignment of three axes. */
Matrix3d distortion(double scale, double misalignment, Random& random)
{
    Matrix3d m = Matrix3d::Identity();
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            m(row, column) += (row == column ? scale : misalignment) * random.normal();
    return m;
}

/** One triad of sensors, gyroscopes or accelerometers. */
class Triad
{
 public:
    struct Errors
    {
        double density, walk, bias, scale, misalignment, range, vibration;
    };
    Triad(const Errors& e, const ImuConfig& config, std::uint64_t seed, std::uint64_t stream)
        : errors_(e),
          dt_(1 / config.rate),
          frequency_(config.vibration_frequency),
          random_(seed, stream),
          bias_(e.bias * random_.normalVector()),
          distortion_(distortion(e.scale, e.misalignment, random_))
    {
        const double x = M_PI * frequency_ * dt_;
        gain_ = config.averaging && x > 0 ? std::sin(x) / x : 1;
        for (double& phase : phases_) phase = random_.uniform(0, 2 * M_PI);
    }

    /** Reads a true value at time t and lets the bias walk on; bias() is that of this reading. */
    Vector3d read(const Vector3d& value, double t)
    {
        Vector3d shaken = value;
        for (int i = 0; i < 3; i++)
            shaken[i] +=
                errors_.vibration * gain_ * std::sin(2 * M_PI * frequency_ * t + phases_[i]);
        read_bias_ = bias_;
        bias_ += errors_.walk * std::sqrt(dt_) * random_.normalVector();
        const Vector3d noise = errors_.density / std::sqrt(dt_) * random_.normalVector();
        return (distortion_ * shaken + read_bias_ + noise)
            .cwiseMax(-errors_.range)
            .cwiseMin(errors_.range);
    }
    const Vector3d& bias() const { return read_bias_; }

 private:
    Errors errors_;
    double dt_, frequency_, gain_ = 1;
    Random random_;
    Vector3d bias_;
    Matrix3d distortion_;
    std::array<double, 3> phases_{};
    Vector3d read_bias_ = Vector3d::Zero();
};
}  // namespace

ImuSample trueImu(const MotionState& state)
{
    ImuSample s;
    s.gyro = state.rate;
    s.accel = state.T_world_imu.R.transpose() * (state.a_world + kGravity);
    return s;
}

ImuRecording simulateImu(
    const ImuConfig& config, const Motion& motion, double duration, std::uint64_t seed)
{
    Triad gyro(
        {config.noise.gyro, config.noise.gyro_bias_walk, config.gyro_bias, config.gyro_scale,
         config.gyro_misalignment, config.gyro_range, config.gyro_vibration},
        config, seed, 10);
    Triad accel(
        {config.noise.accel, config.noise.accel_bias_walk, config.accel_bias, config.accel_scale,
         config.accel_misalignment, config.accel_range, config.accel_vibration},
        config, seed, 11);

    ImuRecording recording;
    const double dt = 1 / config.rate;
    const auto count = static_cast<std::int64_t>(duration * config.rate);
    for (std::int64_t i = 0; i < count; i++)
    {
        const double middle = (static_cast<double>(i) + 0.5) * dt;
        const Duration t = kTick * static_cast<Duration>(std::llround(middle * 1e7));
        const ImuSample truth = meanImu(motion, toSeconds(t), config.averaging ? dt : 0);
        ImuSample sample;
        sample.t = t + kTick * static_cast<Duration>(std::llround(config.clock_offset * 1e7));
        sample.gyro = gyro.read(truth.gyro, toSeconds(t));
        sample.accel = accel.read(truth.accel, toSeconds(t));
        recording.samples.push_back(sample);
        recording.times.push_back(t);
        recording.gyro_bias.push_back(gyro.bias());
        recording.accel_bias.push_back(accel.bias());
    }
    return recording;
}

ImuConfig imuPreset(ImuPreset preset)
{
    ImuConfig c;
    c.type = preset;
    c.noise = {0, 0, 0, 0};
    if (preset == ImuPreset::Ideal) return c;
    c.noise = {2.36e-4, 2.26e-3, 2e-5, 3e-4};
    c.gyro_bias = 5e-3;
    c.accel_bias = 0.05;
    c.gyro_scale = 1e-3;
    c.accel_scale = 1e-3;
    c.gyro_misalignment = 5e-4;
    c.accel_misalignment = 5e-4;
    c.gyro_range = 17.4;
    c.accel_range = 176;
    return c;
}

void declare(ConfigSection& section, ImuConfig& config)
{
    section.choice<ImuPreset>(
        "type", config.type, {{"ideal", ImuPreset::Ideal}, {"industrial", ImuPreset::Industrial}},
        "preset that the other keys change");
    config = imuPreset(config.type);
    const auto key = [&section](const char* name, double& value, const char* doc)
    { section.key(name, value, kNotNegative, doc); };
    section.key("rate", config.rate, {10, 10000}, "Hz");
    key("gyro_noise", config.noise.gyro, "rad/s/sqrt(Hz)");
    key("accel_noise", config.noise.accel, "m/s^2/sqrt(Hz)");
    key("gyro_bias_walk", config.noise.gyro_bias_walk, "rad/s^2/sqrt(Hz)");
    key("accel_bias_walk", config.noise.accel_bias_walk, "m/s^3/sqrt(Hz)");
    key("gyro_bias", config.gyro_bias, "rad/s, turn-on, standard deviation");
    key("accel_bias", config.accel_bias, "m/s^2, turn-on, standard deviation");
    key("gyro_scale", config.gyro_scale, "scale error, standard deviation");
    key("accel_scale", config.accel_scale, "scale error, standard deviation");
    key("gyro_misalignment", config.gyro_misalignment, "rad, standard deviation");
    key("accel_misalignment", config.accel_misalignment, "rad, standard deviation");
    key("gyro_range", config.gyro_range, "rad/s, saturation");
    key("accel_range", config.accel_range, "m/s^2, saturation");
    section.key("clock_offset", config.clock_offset, {-1, 1}, "s, IMU stamps against LiDAR stamps");
    key("gyro_vibration", config.gyro_vibration, "rad/s, amplitude");
    key("accel_vibration", config.accel_vibration, "m/s^2, amplitude");
    key("vibration_frequency", config.vibration_frequency, "Hz");
    section.key("averaging", config.averaging, "samples are means over their interval");
}
}  // namespace taut::simulation
