#include "taut/simulation/Faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;

namespace
{
ImuSample sampleAt(double t)
{
    ImuSample s;
    s.t = fromSeconds(t);
    return s;
}

SimulatedScan scanAt(double t, std::size_t points = 10)
{
    SimulatedScan s;
    s.scan.stamp = fromSeconds(t);
    s.scan.end = fromSeconds(t + 0.1);
    s.scan.points.resize(points);
    s.truth.resize(points, Eigen::Vector3f::Ones());
    return s;
}
}  // namespace

TEST(Faults, NothingHappensUnasked)
{
    Faults faults({}, 1);
    for (int i = 0; i < 1000; i++)
    {
        ImuSample sample = sampleAt(0.01 * i);
        ASSERT_TRUE(faults.spoil(sample, i));
        ASSERT_EQ(sample.t, fromSeconds(0.01 * i));
        SimulatedScan scan = scanAt(0.1 * i);
        ASSERT_TRUE(faults.spoil(scan, i));
        ASSERT_EQ(scan.scan.stamp, fromSeconds(0.1 * i));
        for (const LidarPoint& p : scan.scan.points) ASSERT_TRUE(p.position.allFinite());
    }
}

TEST(Faults, GapsSwallowSamplesAndScans)
{
    FaultConfig config;
    config.imu_gap = {2, 0.5};
    config.lidar_gap = {3, 0.2};
    Faults faults(config, 1);
    const auto sample = [&](double t)
    {
        ImuSample s = sampleAt(t);
        return faults.spoil(s, 0);
    };
    const auto scan = [&](double t)
    {
        SimulatedScan s = scanAt(t);
        return faults.spoil(s, 0);
    };
    EXPECT_TRUE(sample(1.99));
    EXPECT_FALSE(sample(2));
    EXPECT_FALSE(sample(2.49));
    EXPECT_TRUE(sample(2.5));
    EXPECT_TRUE(scan(2.85));
    EXPECT_FALSE(scan(2.95));  // its end falls into the gap
    EXPECT_FALSE(scan(3.15));
    EXPECT_TRUE(scan(3.25));
}

TEST(Faults, SomePointsAreNotFiniteAndHaveNoTruth)
{
    FaultConfig config;
    config.nan_points = 0.2;
    Faults faults(config, 1);
    SimulatedScan s = scanAt(1, 20000);
    ASSERT_TRUE(faults.spoil(s, 5));
    int bad = 0;
    for (std::size_t i = 0; i < s.truth.size(); i++)
    {
        EXPECT_EQ(s.truth[i].allFinite(), s.scan.points[i].position.allFinite());
        bad += !s.truth[i].allFinite();
    }
    EXPECT_NEAR(bad, 4000, 200);
}

TEST(Faults, ClocksJumpTogetherAndStampsRepeat)
{
    FaultConfig config;
    config.jump_at = 5;
    config.jump_by = -1;
    config.repeated_stamps = 0.1;
    Faults faults(config, 1);
    int repeated = 0;
    Time last = -1;
    for (int i = 0; i < 1000; i++)
    {
        ImuSample s = sampleAt(0.01 * i);
        ASSERT_TRUE(faults.spoil(s, i));
        repeated += s.t == last;
        if (s.t != last)
        {
            EXPECT_EQ(s.t, fromSeconds(0.01 * i - (i >= 500 ? 1 : 0)));
        }
        last = s.t;
    }
    EXPECT_NEAR(repeated, 100, 30);
    EXPECT_EQ(faults.clock(fromSeconds(7)), fromSeconds(6));
}

TEST(Faults, HostStampsAreLateByTheJitterAskedFor)
{
    FaultConfig config;
    config.imu_stamps.jitter = 0.4e-3;
    config.lidar_stamps.jitter = 3e-3;
    Faults faults(config, 1);
    double sum = 0, square = 0, scans = 0;
    constexpr int count = 20000;
    Time last = -1;
    for (int i = 0; i < count; i++)
    {
        ImuSample s = sampleAt(0.01 * i);
        ASSERT_TRUE(faults.spoil(s, i));
        const double late = toSeconds(s.t) - 0.01 * i;
        ASSERT_GE(late, -1e-9);
        ASSERT_GE(s.t, last) << "who comes later is not stamped earlier";
        last = s.t;
        sum += late / count;
        square += late * late / count;
        SimulatedScan scan = scanAt(0.1 * i, 1);
        ASSERT_TRUE(faults.spoil(scan, i));
        scans += (toSeconds(scan.scan.stamp) - 0.1 * i) / count;
        ASSERT_EQ(scan.scan.end - scan.scan.stamp, 100'000'000);
    }
    // Exponential: mean and deviation are the same.
    EXPECT_NEAR(sum, 0.4e-3, 0.02e-3);
    EXPECT_NEAR(std::sqrt(square - sum * sum), 0.4e-3, 0.02e-3);
    EXPECT_NEAR(scans, 3e-3, 0.1e-3);
}

TEST(Faults, PolledStampsAreMultiplesOfTheStep)
{
    FaultConfig config;
    config.imu_stamps.step = 0.016;
    Faults faults(config, 1);
    double sum = 0, square = 0;
    int repeated = 0;
    Time last = -1;
    constexpr int count = 16000;
    for (int i = 0; i < count; i++)
    {
        ImuSample s = sampleAt(0.005 * i);
        ASSERT_TRUE(faults.spoil(s, i));
        ASSERT_EQ(s.t % 16'000'000, 0);
        repeated += s.t == last;
        last = s.t;
        const double late = toSeconds(s.t) - 0.005 * i;
        sum += late / count;
        square += late * late / count;
    }
    // Every whole millisecond from 0 to 15 is equally often late.
    EXPECT_NEAR(sum, 7.5e-3, 1e-5);
    EXPECT_NEAR(std::sqrt(square - sum * sum), 1e-3 * std::sqrt((16 * 16 - 1) / 12.0), 1e-5);
    EXPECT_NEAR(repeated, count * (1 - 5.0 / 16), 2) << "several samples a poll";
}
