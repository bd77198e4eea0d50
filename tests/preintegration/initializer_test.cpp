#include "taut/preintegration/Initializer.h"

#include <gtest/gtest.h>

#include "steady_turn.h"
#include "taut/core/WarningLog.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kSecond = 1'000'000'000;
constexpr Duration kPeriod = kSecond / 200;

/** An IMU with noise, on a body that rests until told otherwise. */
class InitializerTest : public ::testing::Test
{
 protected:
    InitializerTest() { body.bias_accel = body.T_world_imu.R.transpose() * Vector3d(0, 0, 0.06); }

    /** Feeds samples of `motion` for some seconds; true as soon as there is a result. */
    template <class Motion>
    bool feed(Initializer& initializer, double seconds, const Motion& motion)
    {
        for (const Time end = now + fromSeconds(seconds); now < end; now += kPeriod)
        {
            ImuSample s = motion(now);
            s.gyro += random.vector(gyro_noise / std::sqrt(toSeconds(kPeriod)));
            s.accel += random.vector(accel_noise / std::sqrt(toSeconds(kPeriod)));
            if (initializer.add(s)) return true;
        }
        return false;
    }

    bool rest(Initializer& initializer, double seconds)
    {
        return feed(initializer, seconds, [&](Time t) { return body.sample(t); });
    }

    bool walk(Initializer& initializer, double seconds)
    {
        return feed(
            initializer, seconds,
            [&](Time t)
            {
                ImuSample s = body.sample(t);
                const double phase = 2 * M_PI * 1.3 * toSeconds(t - start);
                s.gyro += Vector3d(0.3, -0.2, 0.8) * std::sin(phase + 1);
                s.accel += Vector3d(1, 2, 1.5) * std::sin(phase + 1);
                return s;
            });
    }

    void expectTrueAttitude(const Initialization& found) const
    {
        // Yaw is 0 by definition: what can be compared is where up is in the body.
        const Vector3d up = found.estimate.state.T_world_imu.R.row(2).transpose();
        const Vector3d truth = body.T_world_imu.R.row(2).transpose();
        EXPECT_LT(up.cross(truth).norm(), 2e-3);
        EXPECT_NEAR(found.estimate.state.T_world_imu.R(1, 0), 0, 1e-12);
    }

    const Time start = 1'700'000'000 * kSecond;
    Time now = start;
    double gyro_noise = 1e-3, accel_noise = 1e-2;
    SteadyTurn body = SteadyTurn::rest();
    Random random{1};
    WarningLog log;
    InitializationConfig config;
};
}  // namespace

TEST_F(InitializerTest, ARestGivesAttitudeAndBiases)
{
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(rest(initializer, 9));
    EXPECT_FALSE(initializer.result());
    ASSERT_TRUE(rest(initializer, 2));
    const Initialization& found = *initializer.result();
    EXPECT_TRUE(found.at_rest);
    EXPECT_NEAR(found.rest_duration, 10, 0.3);
    expectTrueAttitude(found);
    const NavState& x = found.estimate.state;
    EXPECT_EQ(x.t, start);
    EXPECT_LT((x.bias_gyro - body.bias_gyro).norm(), 1e-3);
    EXPECT_LT((x.bias_accel - body.bias_accel).norm(), 0.01);  // along gravity it can be seen
    EXPECT_EQ(x.v_world, Vector3d::Zero());
    EXPECT_NEAR(found.measured_noise.gyro, gyro_noise, 0.05 * gyro_noise);
    EXPECT_NEAR(found.measured_noise.accel, accel_noise, 0.05 * accel_noise);
    EXPECT_TRUE(log.counts().empty());
}

TEST_F(InitializerTest, ABodySwaysAsFarAsItTurnsAtRest)
{
    const auto swayOf = [&](double amplitude)  // [rad], at 0.4 Hz
    {
        now = start;
        Initializer initializer(config, log.sink());
        const bool found = feed(
            initializer, 11,
            [&](Time t)
            {
                ImuSample s = body.sample(t);
                const double rate = 2 * M_PI * 0.4;
                s.gyro.x() += amplitude * rate * std::cos(rate * toSeconds(t - start));
                return s;
            });
        EXPECT_TRUE(found);
        return initializer.result()->position_sigma;
    };
    gyro_noise = 1e-5;
    EXPECT_EQ(swayOf(0), config.min_sway);
    EXPECT_NEAR(swayOf(5e-3), config.sway_lever * 5e-3, 1e-3);
    config.max_sway = 2.5e-3;
    EXPECT_EQ(swayOf(5e-3), config.max_sway);
}

TEST_F(InitializerTest, TiltAndAccelerometerBiasAreCorrelated)
{
    Initializer initializer(config, log.sink());
    ASSERT_TRUE(rest(initializer, 11));
    const NavEstimate& found = initializer.result()->estimate;
    const Matrix3d& R = found.state.T_world_imu.R;
    const Eigen::Matrix<double, 6, 6> P =
        found.covariance.block<6, 6>(NavState::kRotation, NavState::kRotation);
    EXPECT_LT((P - P.transpose()).norm(), 1e-12);

    // A tilt about the world's x looks like a bias along the world's y: each is known only as well
    // as the bias is, their sum as well as the mean specific force.
    const Vector3d x = R.transpose() * Vector3d::UnitX(), y = R.transpose() * Vector3d::UnitY();
    const double tilt = x.dot(P.topLeftCorner<3, 3>() * x);
    const double bias = y.dot(P.bottomRightCorner<3, 3>() * y);
    const double both = x.dot(P.topRightCorner<3, 3>() * y);
    EXPECT_NEAR(std::sqrt(tilt), config.accel_bias_sigma / 9.81, 1e-3);
    EXPECT_NEAR(std::sqrt(bias), config.accel_bias_sigma, 1e-3);
    EXPECT_GT(std::abs(both) / std::sqrt(tilt * bias), 0.99);

    Eigen::Matrix<double, 3, 6> J;  // of the mean specific force R^T g + ba
    J << hat(R.transpose() * kGravityWorld), Matrix3d::Identity();
    const Eigen::Matrix3d force = J * P * J.transpose();
    EXPECT_LT(std::sqrt(force.trace()), 0.02);
    EXPECT_GT(found.covariance.llt().matrixL().determinant(), 0);
}

TEST_F(InitializerTest, AShorterRestIsUsedAndReported)
{
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(rest(initializer, 3));
    ASSERT_TRUE(walk(initializer, 2));
    EXPECT_TRUE(initializer.result()->at_rest);
    EXPECT_NEAR(initializer.result()->rest_duration, 3, 0.5);
    EXPECT_EQ(initializer.result()->position_sigma, config.max_sway);
    EXPECT_EQ(initializer.result()->estimate.state.t, start);
    expectTrueAttitude(*initializer.result());
    ASSERT_EQ(log.count("short_rest"), 1u);
    EXPECT_NEAR(toSeconds(log.kept()[0].t - start), 3, 0.5);
}

TEST_F(InitializerTest, TheNoiseOfASensorIsNoMotion)
{
    gyro_noise = 4e-3;
    accel_noise = 4e-2;
    for (int i = 0; i < 20; i++)
    {
        Initializer initializer(config, log.sink());
        ASSERT_TRUE(rest(initializer, 11)) << i;
        EXPECT_TRUE(initializer.result()->at_rest);
        EXPECT_NEAR(initializer.result()->rest_duration, config.rest_duration, 0.3);
    }
    EXPECT_TRUE(log.counts().empty());
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(rest(initializer, 4));
    ASSERT_TRUE(walk(initializer, 1));
    EXPECT_NEAR(initializer.result()->rest_duration, 4, 0.5);
    EXPECT_EQ(log.count("short_rest"), 1u);
}

TEST_F(InitializerTest, StartsInMotionWithAPriorThatSaysSo)
{
    config.on_motion = OnMotion::Start;
    Initializer initializer(config, log.sink());
    ASSERT_TRUE(walk(initializer, 2));
    const Initialization& found = *initializer.result();
    EXPECT_FALSE(found.at_rest);
    EXPECT_EQ(log.count("no_rest"), 1u);
    EXPECT_EQ(found.measured_noise.accel, 0);
    const auto sigma = found.estimate.covariance.diagonal().cwiseSqrt().eval();
    EXPECT_NEAR(sigma[NavState::kVelocity], config.moving_velocity_sigma, 1e-9);
    EXPECT_NEAR(sigma[NavState::kBiasGyro], config.gyro_bias_sigma, 1e-9);
    EXPECT_GT(sigma.segment<3>(NavState::kRotation).maxCoeff(), 0.5 * config.moving_tilt_sigma);
}

TEST_F(InitializerTest, WaitsForTheNextRest)
{
    config.on_motion = OnMotion::Wait;
    config.rest_duration = 2;
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(walk(initializer, 4));
    const Time stop = now;
    ASSERT_TRUE(rest(initializer, 3));
    EXPECT_TRUE(initializer.result()->at_rest);
    EXPECT_GE(initializer.result()->estimate.state.t, stop - fromSeconds(config.window));
    expectTrueAttitude(*initializer.result());
    EXPECT_EQ(log.count("no_rest"), 1u);  // once, not for every window
}

TEST_F(InitializerTest, ASteadyTurnIsNoRest)
{
    body.rate = {0, 0, 0.5};
    Initializer initializer(config, log.sink());
    ASSERT_TRUE(rest(initializer, 11));
    EXPECT_FALSE(initializer.result()->at_rest);
    EXPECT_EQ(log.count("no_rest"), 1u);
}

TEST_F(InitializerTest, AVibrationIsARest)
{
    Initializer initializer(config, log.sink());
    const bool done = feed(
        initializer, 11,
        [&](Time t)
        {
            ImuSample s = body.sample(t);
            s.gyro.x() += 0.3 * std::sin(2 * M_PI * 36 * toSeconds(t - start));
            s.accel.y() += 4 * std::sin(2 * M_PI * 48 * toSeconds(t - start));
            return s;
        });
    ASSERT_TRUE(done);
    EXPECT_TRUE(initializer.result()->at_rest);
    EXPECT_TRUE(log.counts().empty());
    EXPECT_LT((initializer.result()->estimate.state.bias_gyro - body.bias_gyro).norm(), 3e-3);
    expectTrueAttitude(*initializer.result());
    EXPECT_GT(initializer.result()->measured_noise.accel, 0.05);
}

TEST_F(InitializerTest, AForceThatIsNotGravityIsNoRest)
{
    Initializer initializer(config, log.sink());
    ASSERT_TRUE(feed(
        initializer, 11,
        [&](Time t)
        {
            ImuSample s = body.sample(t);
            s.accel /= 9.81;  // an IMU that reports in units of g
            return s;
        }));
    EXPECT_FALSE(initializer.result()->at_rest);
    EXPECT_EQ(log.count("no_rest"), 1u);
}

TEST_F(InitializerTest, ARecordingThatEndsEarlyIsUsedAsItIs)
{
    accel_noise = 0.02;
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(rest(initializer, 2.045));  // the last window holds a single, noisy sample
    ASSERT_TRUE(initializer.finish());
    EXPECT_TRUE(initializer.result()->at_rest);
    EXPECT_NEAR(initializer.result()->rest_duration, 2, 0.3);
    EXPECT_EQ(log.count("no_rest"), 0u);
    EXPECT_EQ(log.count("short_rest"), 0u);  // it did not move
}

TEST_F(InitializerTest, NeverStartsInMotionSilently)
{
    for (const OnMotion choice : {OnMotion::Start, OnMotion::Wait})
    {
        config.on_motion = choice;
        Initializer initializer(config, log.sink());
        rest(initializer, 0.3);
        const std::size_t before = log.count("no_rest");
        ASSERT_EQ(initializer.finish(), choice == OnMotion::Start);
        EXPECT_FALSE(initializer.result() && initializer.result()->at_rest);
        EXPECT_EQ(log.count("no_rest"), before + 1);
    }
}

TEST_F(InitializerTest, HasNoResultWithoutSamples)
{
    Initializer initializer(config, log.sink());
    EXPECT_FALSE(initializer.finish());
    EXPECT_FALSE(initializer.result());
}

TEST_F(InitializerTest, WorksWithoutAWarningSink)
{
    Initializer initializer(config, {});
    EXPECT_TRUE(walk(initializer, 2));
}
