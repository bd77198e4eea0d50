/** \file
 * What every preintegrator must do: add a class name below to hold another one to it. */
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "steady_turn.h"
#include "taut/core/Plugins.h"
#include "taut/core/Preintegrator.h"
#include "taut/factors/ImuFactor.h"
#include "taut/preintegration/Register.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kBegin = 1'700'000'000'123'456'789, kEnd = kBegin + 100 * kMillisecond;

class AnyPreintegrator : public ::testing::TestWithParam<const char*>
{
 protected:
    void SetUp() override
    {
        registerPreintegrators();
        ConfigSection section;
        preintegrator = createPlugin<Preintegrator>(GetParam());
        preintegrator->configure(section);
        body = SteadyTurn::rest();
        body.bias_accel.setZero();
        body.bias_gyro.setZero();
    }

    /** Of the body that moves from time 0 on, seen from kBegin on. */
    PreintegrationRequest request(Time end = kEnd)
    {
        samples = body.samples(-10 * kMillisecond, end - kBegin, 5 * kMillisecond);
        for (ImuSample& s : samples) s.t += kBegin;
        PreintegrationRequest r;
        r.begin = kBegin;
        r.end = end;
        r.samples = &samples;
        r.previous = body.at(0);
        r.previous.t = kBegin;
        r.previous_rate = body.rate;
        return r;
    }

    std::shared_ptr<Preintegrator> preintegrator;
    SteadyTurn body;
    ImuSamples samples;
};
}  // namespace

TEST_P(AnyPreintegrator, ReachesFromTheEndBackToTheBegin)
{
    body = SteadyTurn();
    for (const Duration length : {100 * kMillisecond, 3 * kMillisecond, Duration{1}})
    {
        const PreintegratedImu chain = preintegrator->integrate(request(kBegin + length));
        ASSERT_GE(chain.knots.size(), 2u);
        EXPECT_EQ(chain.begin(), kBegin);
        EXPECT_EQ(chain.end(), kBegin + length);
        EXPECT_EQ(chain.knots.front().delta.gamma, Matrix3d::Identity());
        EXPECT_EQ(chain.knots.front().delta.alpha, Vector3d::Zero());
        EXPECT_EQ(chain.knots.front().delta.beta, Vector3d::Zero());
        for (std::size_t i = 1; i < chain.knots.size(); i++)
            EXPECT_LT(chain.knots[i].sample.t, chain.knots[i - 1].sample.t);
    }
}

TEST_P(AnyPreintegrator, KeepsABodyAtRestWhereItIs)
{
    const NavState after = predict(preintegrator->integrate(request()), body.at(0));
    EXPECT_LT(after.localFrom(body.at(0)).norm(), 1e-10);
}

TEST_P(AnyPreintegrator, FollowsACircle)
{
    // Constant twist: 3 m/s forward while turning by 2 rad/s, on a circle of 1.5 m.
    const double rate = 2, speed = 3;
    const double seconds = toSeconds(kEnd - kBegin);
    const Matrix3d R = body.T_world_imu.R;
    PreintegrationRequest r = request();
    r.previous.v_world = R * Vector3d(speed, 0, 0);
    r.previous_rate = {0, 0, rate};
    const auto turned = [&](double s) -> Matrix3d { return R * expSO3({0, 0, rate * s}); };
    for (ImuSample& s : samples)
        s = {
            s.t, r.previous_rate,
            Vector3d(0, rate * speed, 0) +
                turned(toSeconds(s.t - kBegin)).transpose() * kGravityWorld};
    const NavState after = predict(preintegrator->integrate(r), r.previous);
    const double angle = rate * seconds;
    const Vector3d on_circle = speed / rate * Vector3d(std::sin(angle), 1 - std::cos(angle), 0);
    EXPECT_LT((after.T_world_imu.p - r.previous.T_world_imu.p - R * on_circle).norm(), 2e-5);
    EXPECT_LT((after.v_world - turned(seconds) * Vector3d(speed, 0, 0)).norm(), 2e-4);
    EXPECT_LT(logSO3(after.T_world_imu.R.transpose() * turned(seconds)).norm(), 1e-9);
}

TEST_P(AnyPreintegrator, CovarianceIsPositiveAndGrowsWithTheInterval)
{
    body = SteadyTurn();
    Eigen::Matrix<double, 9, 9> before = Eigen::Matrix<double, 9, 9>::Zero();
    for (const int milliseconds : {20, 50, 100, 400})
    {
        const PreintegratedImu chain =
            preintegrator->integrate(request(kBegin + milliseconds * kMillisecond));
        EXPECT_LT((chain.covariance - chain.covariance.transpose()).norm(), 1e-12);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(chain.covariance);
        EXPECT_GT(eigen.eigenvalues()[0], 0);
        EXPECT_TRUE((chain.covariance.diagonal().array() > before.diagonal().array()).all());
        EXPECT_TRUE((chain.bias_walk_covariance.diagonal().array() > 0).all());
        before = chain.covariance;
    }
}

TEST_P(AnyPreintegrator, RefusesAnIntervalThatIsEmptyOrBackward)
{
    PreintegrationRequest r = request();
    r.end = r.begin;
    EXPECT_THROW(preintegrator->integrate(r), std::invalid_argument);
    r.end = r.begin - 1;
    EXPECT_THROW(preintegrator->integrate(r), std::invalid_argument);
}

TEST_P(AnyPreintegrator, NeedsSamplesOnlyIfItSaysSo)
{
    PreintegrationRequest r = request();
    samples.clear();
    if (preintegrator->needsImu())
        EXPECT_THROW(preintegrator->integrate(r), std::invalid_argument);
    else
        EXPECT_NO_THROW(preintegrator->integrate(r));
}

TEST_P(AnyPreintegrator, CopiesAreIndependentAndAgree)
{
    const auto copy =
        std::dynamic_pointer_cast<Preintegrator>(preintegrator->duplicateGetSmartPtr());
    ASSERT_TRUE(copy);
    const auto a = preintegrator->integrate(request()), b = copy->integrate(request());
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.knots.back().delta.alpha, b.knots.back().delta.alpha);
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyPreintegrator,
    ::testing::Values("taut::MidpointPreintegrator", "taut::ConstantVelocityPreintegrator"),
    [](const auto& test) { return std::string(test.param).substr(6); });
