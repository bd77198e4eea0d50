#include "taut/odometry/Rest.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace taut;

namespace
{
constexpr Duration kSecond = 1'000'000'000;

/** A rest of 2 s somewhere in the world. */
class RestTest : public testing::Test
{
 protected:
    RestTest()
    {
        initialization.rest_duration = 2;
        initialization.position_sigma = 0.004;
        NavState& x = initialization.estimate.state;
        x.t = 5 * kSecond;
        x.T_world_imu = {expSO3({0.1, -0.2, 0.3}), {1, 2, 3}};
    }

    /** The body `seconds` after the rest began, as it was then but for a movement. */
    NavState after(double seconds, const Vector3d& turned = {0, 0, 0}) const
    {
        NavState x = initialization.estimate.state;
        x.t += fromSeconds(seconds);
        x.T_world_imu.R = x.T_world_imu.R * expSO3(turned);
        return x;
    }

    static NavState::Matrix covarianceOfVelocity(double sigma)
    {
        NavState::Matrix P = NavState::Matrix::Zero();
        P.diagonal().segment<3>(NavState::kVelocity).setConstant(square(sigma));
        return P;
    }

    /** Of a LiDAR that tells the position along x alone, and every rotation, to `sigma`. */
    static NavState::Matrix tellsAlongX(double sigma)
    {
        NavState::Matrix H = NavState::Matrix::Zero();
        H(NavState::kPosition, NavState::kPosition) = 1 / square(sigma);
        H.diagonal().segment<3>(NavState::kRotation).setConstant(1 / square(sigma));
        return H;
    }

    InitializationConfig config;
    Initialization initialization;
    const NavState::Matrix known = covarianceOfVelocity(1e-3);
};

bool says(const MotionPrior& prior)
{
    return std::isfinite(prior.position_sigma);
}
}  // namespace

TEST_F(RestTest, HoldsThePoseWhileItLasts)
{
    Rest rest(initialization, config);
    const MotionPrior prior = rest.at(after(1), known, 0.01);
    EXPECT_EQ(prior.T_world_imu.p, Vector3d(1, 2, 3));
    EXPECT_EQ(prior.position_sigma, 0.004);
    EXPECT_DOUBLE_EQ(prior.rotation_sigma, 0.004 / config.sway_lever);
    EXPECT_TRUE(std::isinf(prior.velocity_sigma));
}

TEST_F(RestTest, AfterItABodyIsAsFarAwayAsItHasTurnedAndAsFastAsItTurns)
{
    Rest rest(initialization, config);
    const MotionPrior still = rest.at(after(2.1), known, 0);
    EXPECT_EQ(still.position_sigma, config.max_sway);
    EXPECT_TRUE(std::isinf(still.rotation_sigma));
    const MotionPrior turned = rest.at(after(4, {0, 0.3, 0}), known, 0.15);
    EXPECT_NEAR(turned.position_sigma, 0.3 * config.sway_lever, 1e-12);
    EXPECT_NEAR(turned.velocity_sigma, 0.15 * config.sway_lever, 1e-12);
    EXPECT_EQ(rest.at(after(5), known, 0.15).position_sigma, turned.position_sigma)
        << "it may come back another way";
}

TEST_F(RestTest, EndsWhereTheImuTellsOfASpeedThatNoTurnExplains)
{
    for (const double sigma : {1e-3, 0.1})  // of the velocity
    {
        Rest rest(initialization, config);
        const NavState::Matrix P = covarianceOfVelocity(sigma);
        NavState moving = after(3);
        const double rate = 0.1;
        const double explained = std::hypot(config.sway_lever * rate, sigma);
        moving.v_world = {0, 3.9 * explained, 0};
        EXPECT_TRUE(says(rest.at(moving, P, rate)));
        moving.v_world = {0, 4.1 * explained, 0};
        EXPECT_FALSE(says(rest.at(moving, P, rate)));
        EXPECT_FALSE(says(rest.at(after(4), P, rate))) << "once left it is not taken up again";
    }
}

TEST_F(RestTest, EndsWhereTheBodyTurnsFast)
{
    Rest rest(initialization, config);
    EXPECT_FALSE(says(rest.at(after(3), known, 0.5)));
    Rest longer(initialization, config);
    EXPECT_TRUE(says(longer.at(after(1), known, 0.5))) << "the Initializer found it at rest";
}

TEST_F(RestTest, EndsWhereTheLidarSeesItLeft)
{
    for (const double seconds : {1.0, 3.0})
    {
        Rest rest(initialization, config);
        const double sway = rest.at(after(seconds), known, 0).position_sigma;
        NavState there = after(seconds);
        there.T_world_imu.p.x() += 3.9 * sway;
        EXPECT_FALSE(rest.endIfLeft(there, tellsAlongX(1e-4)));
        EXPECT_TRUE(says(rest.at(after(seconds), known, 0)));
        there.T_world_imu.p.x() += 0.2 * sway;
        const auto left = rest.endIfLeft(there, tellsAlongX(1e-4));
        // Only a rest that the IMU had found is worth a word.
        ASSERT_EQ(left.has_value(), seconds < 2);
        const double expected = seconds < 2 ? 4.1 * sway : 0;
        EXPECT_NEAR(left.value_or(Rest::Displacement{}).moved, expected, 0.01 * sway);
        EXPECT_FALSE(says(rest.at(after(seconds), known, 0)));
    }
}

TEST_F(RestTest, ADirectionThatTheLidarDoesNotTellDoesNotEndIt)
{
    Rest rest(initialization, config);
    rest.at(after(3), known, 0);
    NavState there = after(3);
    there.T_world_imu.p.y() += 1;
    rest.endIfLeft(there, tellsAlongX(1e-4));
    EXPECT_TRUE(says(rest.at(after(3), known, 0)));
}

TEST_F(RestTest, ABodyThatDidNotRestIsNotHeld)
{
    initialization.at_rest = false;
    Rest rest(initialization, config);
    EXPECT_FALSE(says(rest.at(after(0), known, 0)));
    EXPECT_FALSE(says(Rest().at(after(0), known, 0)));
}
