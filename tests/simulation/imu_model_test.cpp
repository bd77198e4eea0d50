#include <gtest/gtest.h>

#include <cmath>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;

namespace
{
/** Position error after integrating the samples of a perfect IMU forward from the true state at the
 * first sample, mid-point rule. */
double integrationError(const Motion& motion, double rate, double duration)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.rate = rate;
    config.averaging = false;
    const ImuRecording imu = simulateImu(config, motion, duration, 1);
    MotionState state = motion.at(toSeconds(imu.times.front()));
    Pose T = state.T_world_imu;
    Vector3d v = state.v_world;
    for (std::size_t i = 1; i < imu.samples.size(); i++)
    {
        const ImuSample &a = imu.samples[i - 1], &b = imu.samples[i];
        const double dt = toSeconds(b.t - a.t);
        const Matrix3d R = T.R * expSO3((a.gyro + b.gyro) / 2 * dt);
        const Vector3d acceleration = (T.R * a.accel + R * b.accel) / 2 - Vector3d(0, 0, 9.81);
        T.p += v * dt + acceleration * dt * dt / 2;
        v += acceleration * dt;
        T.R = R;
    }
    return (T.p - motion.poseAt(toSeconds(imu.times.back())).p).norm();
}

ImuRecording atRest(ImuConfig config, double duration, std::uint64_t seed)
{
    const Motion motion(std::vector<Pose>(10), 1);  // 10 equal poses: rests for ever
    return simulateImu(config, motion, duration, seed);
}
}  // namespace

TEST(ImuModel, PerfectSamplesIntegrateToTheTruthWithTheSquareOfTheStep)
{
    const Motion motion = motionOf(MotionPreset::Violent, 10, 1);
    const double coarse = integrationError(motion, 200, 10);
    const double fine = integrationError(motion, 800, 10);
    const double finest = integrationError(motion, 3200, 10);
    EXPECT_LT(finest, 2e-4);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 1);  // a quarter of the step: 16 times better
    EXPECT_NEAR(std::log2(fine / finest), 4, 0.5);
}

TEST(ImuModel, AtRestItReadsGravityUpwardsInTheBodyFrame)
{
    const Motion motion = motionOf(MotionPreset::Flight, 4, 3);
    const ImuRecording imu = simulateImu(imuPreset(ImuPreset::Ideal), motion, 3, 1);
    ASSERT_GT(imu.samples.size(), 500U);
    for (std::size_t i = 0; i < imu.samples.size(); i++)
    {
        const Matrix3d R = motion.poseAt(toSeconds(imu.times[i])).R;
        EXPECT_LT((imu.samples[i].accel - R.transpose() * Vector3d(0, 0, 9.81)).norm(), 1e-9);
        EXPECT_LT(imu.samples[i].gyro.norm(), 1e-9);
    }
}

TEST(ImuModel, ASampleIsTheMeanOverItsInterval)
{
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.rate = 50;
    const ImuRecording imu = simulateImu(config, motion, 6, 1);
    for (std::size_t i = 150; i < imu.samples.size(); i += 7)
    {
        Vector3d gyro = Vector3d::Zero();
        constexpr int n = 400;
        for (int k = 0; k < n; k++)
        {
            const double t = toSeconds(imu.times[i]) + ((k + 0.5) / n - 0.5) / config.rate;
            gyro += motion.at(t).rate / n;
        }
        EXPECT_LT((imu.samples[i].gyro - gyro).norm(), 1e-4);
        EXPECT_GT((imu.samples[i].gyro - motion.at(toSeconds(imu.times[i])).rate).norm(), 0);
    }
}

TEST(ImuModel, WhiteNoiseHasTheDensityAskedFor)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.noise = {2e-3, 3e-2, 0, 0};
    for (const double rate : {100.0, 400.0})
    {
        config.rate = rate;
        const ImuRecording imu = atRest(config, 100, 5);
        double gyro = 0, accel = 0;
        for (const ImuSample& s : imu.samples)
        {
            gyro += s.gyro.squaredNorm() / 3;
            accel += s.accel.head<2>().squaredNorm() / 2;
        }
        const auto n = static_cast<double>(imu.samples.size());
        EXPECT_NEAR(std::sqrt(gyro / n / rate), 2e-3, 2e-3 * 0.03);
        EXPECT_NEAR(std::sqrt(accel / n / rate), 3e-2, 3e-2 * 0.03);
    }
}

TEST(ImuModel, BiasesWalkAsAskedFor)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.noise = {0, 0, 1e-3, 1e-2};
    double gyro = 0, accel = 0;
    constexpr int runs = 200;
    for (int seed = 0; seed < runs; seed++)
    {
        const ImuRecording imu = atRest(config, 4, static_cast<std::uint64_t>(seed));
        gyro += (imu.gyro_bias.back() - imu.gyro_bias.front()).squaredNorm() / 3 / runs;
        accel += (imu.accel_bias.back() - imu.accel_bias.front()).squaredNorm() / 3 / runs;
    }
    EXPECT_NEAR(std::sqrt(gyro), 1e-3 * 2, 2e-3 * 0.1);  // sqrt(4 s) = 2
    EXPECT_NEAR(std::sqrt(accel), 1e-2 * 2, 2e-2 * 0.1);
}

TEST(ImuModel, ReadingsAreTruthPlusRecordedBias)
{
    const Motion motion = motionOf(MotionPreset::Fast, 6, 1);
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    const ImuRecording ideal = simulateImu(config, motion, 6, 3);
    config.gyro_bias = 0.01;
    config.accel_bias = 0.1;
    config.noise.gyro_bias_walk = 1e-3;
    const ImuRecording biased = simulateImu(config, motion, 6, 3);
    for (std::size_t i = 0; i < ideal.samples.size(); i++)
    {
        EXPECT_LT(
            (biased.samples[i].gyro - ideal.samples[i].gyro - biased.gyro_bias[i]).norm(), 1e-12);
        EXPECT_LT(
            (biased.samples[i].accel - ideal.samples[i].accel - biased.accel_bias[i]).norm(),
            1e-12);
    }
}

TEST(ImuModel, SaturatesAtItsRangeAndShiftsItsClock)
{
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.gyro_range = 2;
    config.clock_offset = 0.005;
    const ImuRecording imu = simulateImu(config, motion, 6, 3);
    double peak = 0;
    for (std::size_t i = 0; i < imu.samples.size(); i++)
    {
        peak = std::max(peak, imu.samples[i].gyro.cwiseAbs().maxCoeff());
        EXPECT_EQ(imu.samples[i].t - imu.times[i], 5'000'000);
    }
    EXPECT_EQ(peak, 2);
}

TEST(ImuModel, VibrationIsHeardAndAveragedAway)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.accel_vibration = 2;
    config.vibration_frequency = 37;
    const auto peak = [](const ImuConfig& c)
    {
        double largest = 0;
        for (const ImuSample& s : atRest(c, 10, 1).samples)
            largest = std::max(largest, std::abs(s.accel.x()));
        return largest;
    };
    const double x = M_PI * 37 / config.rate;
    EXPECT_NEAR(peak(config), 2 * std::sin(x) / x, 0.01);
    config.averaging = false;
    EXPECT_NEAR(peak(config), 2, 0.01);
}

TEST(ImuModel, ItsClockMayRunTooFast)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.clock_offset = -0.003;
    config.clock_drift = 50e-6;
    const ImuRecording imu = atRest(config, 60, 1);
    for (std::size_t i = 0; i < imu.samples.size(); i++)
        ASSERT_NEAR(
            toSeconds(imu.samples[i].t - imu.times[i]), -0.003 + 50e-6 * toSeconds(imu.times[i]),
            51e-9);
}

TEST(ImuModel, BiasesFollowTheTemperature)
{
    ImuConfig config = imuPreset(ImuPreset::Ideal);
    config.rate = 20;
    config.gyro_temperature = 2e-3;
    config.accel_temperature = 0.01;
    const ImuRecording cold = atRest(config, 1, 1);
    EXPECT_EQ(cold.gyro_bias.back(), Vector3d::Zero());
    config.warming = 8;
    config.warming_time = 20;
    double gyro = 0, accel = 0;
    constexpr int units = 400;
    for (int unit = 0; unit < units; unit++)
    {
        const ImuRecording imu = atRest(config, 60, static_cast<std::uint64_t>(unit));
        const auto at = [&imu](double t) { return static_cast<std::size_t>(t * 20); };
        const Vector3d early = imu.gyro_bias[at(20)], late = imu.gyro_bias[at(59)];
        const double expected = (1 - std::exp(-20.025 / 20)) / (1 - std::exp(-59.025 / 20));
        ASSERT_LT((early - expected * late).norm(), 1e-12);
        ASSERT_LT((imu.samples[at(59)].gyro - late).norm(), 1e-12) << "it is in the reading";
        gyro += late.squaredNorm() / 3 / units;
        accel += imu.accel_bias[at(59)].squaredNorm() / 3 / units;
    }
    const double warm = 8 * (1 - std::exp(-59.025 / 20));
    EXPECT_NEAR(std::sqrt(gyro), 2e-3 * warm, 0.05 * 2e-3 * warm);
    EXPECT_NEAR(std::sqrt(accel), 0.01 * warm, 0.05 * 0.01 * warm);
}

TEST(ImuModel, WarmingChangesNoOtherError)
{
    ImuConfig config = imuPreset(ImuPreset::Consumer);
    config.gyro_range = config.accel_range = 1e9;
    const ImuRecording constant = atRest(config, 20, 3);
    config.warming = 10;
    const ImuRecording warming = atRest(config, 20, 3);
    for (std::size_t i = 0; i < constant.samples.size(); i++)
    {
        const Vector3d bias = warming.gyro_bias[i] - constant.gyro_bias[i];
        ASSERT_LT((warming.samples[i].gyro - constant.samples[i].gyro - bias).norm(), 1e-12);
    }
    EXPECT_GT((warming.gyro_bias.back() - constant.gyro_bias.back()).norm(), 1e-3);
}

TEST(ImuModel, PresetsAreWorseTheCheaper)
{
    const ImuConfig tactical = imuPreset(ImuPreset::Tactical);
    const ImuConfig industrial = imuPreset(ImuPreset::Industrial);
    const ImuConfig consumer = imuPreset(ImuPreset::Consumer);
    const auto better = [](const ImuConfig& a, const ImuConfig& b)
    {
        return a.noise.gyro < b.noise.gyro && a.noise.accel < b.noise.accel &&
               a.noise.gyro_bias_walk < b.noise.gyro_bias_walk &&
               a.noise.accel_bias_walk < b.noise.accel_bias_walk && a.gyro_bias < b.gyro_bias &&
               a.accel_bias <= b.accel_bias && a.gyro_scale < b.gyro_scale &&
               a.accel_scale < b.accel_scale && a.accel_misalignment < b.accel_misalignment;
    };
    EXPECT_TRUE(better(tactical, industrial));
    EXPECT_TRUE(better(industrial, consumer));
}
