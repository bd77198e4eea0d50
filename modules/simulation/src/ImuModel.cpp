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
        double density, walk, bias, scale, misalignment, range, vibration, temperature;
    };
    Triad(const Errors& e, const ImuConfig& config, std::uint64_t seed, std::uint64_t stream)
        : errors_(e),
          dt_(1 / config.rate),
          warming_(config.warming),
          warming_time_(config.warming_time),
          frequency_(config.vibration_frequency),
          random_(seed, stream),
          bias_(e.bias * random_.normalVector()),
          distortion_(distortion(e.scale, e.misalignment, random_))
    {
        const double x = M_PI * frequency_ * dt_;
        gain_ = config.averaging && x > 0 ? std::sin(x) / x : 1;
        for (double& phase : phases_) phase = random_.uniform(0, 2 * M_PI);
        Random coefficients(seed, stream, 1);  // apart: what is off changes nothing else
        per_kelvin_ = e.temperature * coefficients.normalVector();
    }

    /** Reads a true value at time t and lets the bias walk on; bias() is that of this reading. */
    Vector3d read(const Vector3d& value, double t)
    {
        Vector3d shaken = value;
        for (int i = 0; i < 3; i++)
            shaken[i] +=
                errors_.vibration * gain_ * std::sin(2 * M_PI * frequency_ * t + phases_[i]);
        read_bias_ = bias_;
        if (warming_ != 0)
            read_bias_ += warming_ * (1 - std::exp(-t / warming_time_)) * per_kelvin_;
        bias_ += errors_.walk * std::sqrt(dt_) * random_.normalVector();
        const Vector3d noise = errors_.density / std::sqrt(dt_) * random_.normalVector();
        return (distortion_ * shaken + read_bias_ + noise)
            .cwiseMax(-errors_.range)
            .cwiseMin(errors_.range);
    }
    const Vector3d& bias() const { return read_bias_; }

 private:
    Errors errors_;
    double dt_, warming_, warming_time_, frequency_, gain_ = 1;
    Random random_;
    Vector3d bias_;
    Matrix3d distortion_;
    Vector3d per_kelvin_;
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
         config.gyro_misalignment, config.gyro_range, config.gyro_vibration,
         config.gyro_temperature},
        config, seed, 10);
    Triad accel(
        {config.noise.accel, config.noise.accel_bias_walk, config.accel_bias, config.accel_scale,
         config.accel_misalignment, config.accel_range, config.accel_vibration,
         config.accel_temperature},
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
        const double ahead = config.clock_offset + config.clock_drift * toSeconds(t);
        sample.t = t + kTick * static_cast<Duration>(std::llround(ahead * 1e7));
        sample.gyro = gyro.read(truth.gyro, toSeconds(t));
        sample.accel = accel.read(truth.accel, toSeconds(t));
        recording.samples.push_back(sample);
        recording.times.push_back(t);
        recording.gyro_bias.push_back(gyro.bias());
        recording.accel_bias.push_back(accel.bias());
    }
    return recording;
}

// Where a source gives limits, a third of them is taken as the standard deviation.
namespace
{
constexpr double kDegree = M_PI / 180, kMilliG = 9.81e-3;

/** STIM300, data sheet TS1524 (10 g accelerometers). */
ImuConfig tactical()
{
    ImuConfig c;
    c.noise.gyro = 0.15 / 60 * kDegree;  // 0.15 deg/sqrt(h)
    c.noise.accel = 0.06 / 60;           // 0.06 m/s/sqrt(h)
    // Instabilities of 0.5 deg/h and 0.05 mg: the walk that meets them at 300 s of averaging, B
    // sqrt(3/300).
    c.noise.gyro_bias_walk = 0.5 / 3600 * kDegree / 10;
    c.noise.accel_bias_walk = 0.05 * kMilliG / 10;
    c.gyro_bias = 250.0 / 3600 * kDegree / 3;  // range of the bias: 250 deg/h
    c.accel_bias = 0.75 * kMilliG;             // on/off
    c.gyro_scale = 500e-6;
    c.accel_scale = 300e-6;
    c.gyro_misalignment = c.accel_misalignment = 1e-3;
    c.gyro_range = 400 * kDegree;
    c.accel_range = 10 * 9.81;
    return c;
}

/** ADIS16448. Noise and walks as calibrated for the EuRoC data set (sensor.yaml of imu0); the rest
 * from the data sheet, whose bias repeatability of 0.5 deg/s and 20 mg RotorS takes as standard
 * deviation too. */
ImuConfig industrial()
{
    ImuConfig c;
    c.noise = {1.6968e-4, 2.0e-3, 1.9393e-5, 3.0e-3};
    c.gyro_bias = 0.5 * kDegree;
    c.accel_bias = 20 * kMilliG;
    c.gyro_scale = c.accel_scale = 0.01 / 3;  // 1 %
    c.gyro_misalignment = 0.05 * kDegree;     // axis to axis
    c.accel_misalignment = 0.2 * kDegree;
    c.gyro_range = 1000 * kDegree;
    c.accel_range = 18 * 9.81;
    return c;
}

/** MPU-9250, data sheet PS-MPU-9250A-01 rev. 1.0, tables 1 and 2. */
ImuConfig consumer()
{
    ImuConfig c;
    c.noise.gyro = 0.01 * kDegree;  // 0.01 deg/s/sqrt(Hz)
    // 8 mg rms in 94 Hz of a first-order filter: more than the 0.3 mg/sqrt(Hz) of the line above
    // it.
    c.noise.accel = 8 * kMilliG / std::sqrt(94 * M_PI / 2);
    // The data sheet is silent; RotorS doubles the calibrated walks of an ADIS16448.
    c.noise.gyro_bias_walk = 2 * 1.9393e-5;
    c.noise.accel_bias_walk = 2 * 3.0e-3;
    c.gyro_bias = 5 * kDegree / 3;    // 5 deg/s
    c.accel_bias = 60 * kMilliG / 3;  // 60 mg
    c.gyro_scale = c.accel_scale = 0.03 / 3;
    c.gyro_misalignment = c.accel_misalignment = 0.02 / 3;  // cross-axis sensitivity 2 %
    c.gyro_range = 2000 * kDegree;
    c.accel_range = 16 * 9.81;
    c.gyro_temperature = 30.0 / 65 * kDegree / 3;  // 30 deg/s between 25 and -40 degrees C
    c.accel_temperature = 1.5 * kMilliG / 3;       // 1.5 mg/K
    return c;
}
}  // namespace

ImuConfig imuPreset(ImuPreset preset)
{
    ImuConfig c;
    switch (preset)
    {
        case ImuPreset::Ideal:
            c.noise = {0, 0, 0, 0};
            break;
        case ImuPreset::Tactical:
            c = tactical();
            break;
        case ImuPreset::Industrial:
            c = industrial();
            break;
        case ImuPreset::Consumer:
            c = consumer();
            break;
    }
    c.type = preset;
    return c;
}

void declare(ConfigSection& section, ImuConfig& config)
{
    section.choice<ImuPreset>(
        "type", config.type,
        {{"ideal", ImuPreset::Ideal},
         {"tactical", ImuPreset::Tactical},
         {"industrial", ImuPreset::Industrial},
         {"consumer", ImuPreset::Consumer}},
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
    section.key(
        "clock_drift", config.clock_drift, {-0.01, 0.01},
        "s/s, by which the IMU's clock is too fast; 1e-6 = 1 ppm");
    section.key("warming", config.warming, {-150, 150}, "K, in the end; 0 = constant temperature");
    section.key("warming_time", config.warming_time, kPositive, "s, time constant of the warming");
    key("gyro_temperature", config.gyro_temperature,
        "rad/s/K, bias by temperature, standard deviation");
    key("accel_temperature", config.accel_temperature,
        "m/s^2/K, bias by temperature, standard deviation");
    key("gyro_vibration", config.gyro_vibration, "rad/s, amplitude");
    key("accel_vibration", config.accel_vibration, "m/s^2, amplitude");
    key("vibration_frequency", config.vibration_frequency, "Hz");
    section.key("averaging", config.averaging, "samples are means over their interval");
}
}  // namespace taut::simulation
