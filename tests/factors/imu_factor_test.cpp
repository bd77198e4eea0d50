#include "taut/factors/ImuFactor.h"

#include <gtest/gtest.h>

#include "steady_turn.h"
#include "taut/preintegration/ConstantVelocityPreintegrator.h"
#include "taut/preintegration/MidpointPreintegrator.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kEnd = 100 * kMillisecond;

PreintegratedImu integrate(
    const SteadyTurn& body, const ImuSamples& samples, const ImuNoise& noise = {})
{
    PreintegrationRequest request;
    request.end = kEnd;
    request.samples = &samples;
    request.previous = body.at(0);
    request.noise = noise;
    MidpointPreintegrator preintegrator;
    preintegrator.config.gyro_scale_error = preintegrator.config.accel_scale_error = 0;
    return preintegrator.integrate(request);
}
}  // namespace

TEST(ImuFactor, JacobiansAreThoseOfTheResidual)
{
    Random random(1);
    for (int i = 0; i < 10; i++)
    {
        SteadyTurn body;
        body.rate = 5 * random.vector(1);
        body.acceleration = random.vector(5);
        const PreintegratedImu imu = integrate(body, body.samples(0, kEnd, 2 * kMillisecond));
        const double gap = i < 5 ? 0.01 : 0.5;
        const NavState previous = disturbed(body.at(0), random, gap);
        const NavState current = disturbed(body.at(kEnd), random, gap);
        const ImuResidual f = linearizeImu(imu, previous, current);
        EXPECT_EQ(f.residual, imuResidual(imu, previous, current));
        const auto by_previous = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
        { return imuResidual(imu, previous.retract(d), current); };
        const auto by_current = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
        { return imuResidual(imu, previous, current.retract(d)); };
        EXPECT_LT(
            (f.d_previous - numericJacobian(by_previous, NavState::kSize)).cwiseAbs().maxCoeff(),
            1e-8);
        EXPECT_LT(
            (f.d_current - numericJacobian(by_current, NavState::kSize)).cwiseAbs().maxCoeff(),
            1e-8);
    }
}

TEST(ImuFactor, ThePredictedStateHasNoResidual)
{
    Random random(2);
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body, body.samples(0, kEnd, 2 * kMillisecond));
    for (int i = 0; i < 10; i++)
    {
        NavState previous = randomState(random);
        previous.bias_accel = imu.bias_accel;  // as they were when the chain was integrated
        previous.bias_gyro = imu.bias_gyro;
        const NavState current = predict(imu, previous);
        EXPECT_EQ(current.t, imu.end());
        EXPECT_LT(imuResidual(imu, previous, current).norm(), 1e-12);
    }
}

TEST(ImuFactor, TheTrueMotionHasNoResidual)
{
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body, body.samples(0, kEnd, kMillisecond));
    EXPECT_LT(imuResidual(imu, body.at(0), body.at(kEnd)).norm(), 1e-5);
}

TEST(ImuFactor, CovarianceOfARateThatNothingMeasuresIsThatOfManyWalks)
{
    PreintegrationRequest request;
    request.end = kEnd;
    request.previous_rate = {0.3, -0.2, 0.5};
    ConstantVelocityPreintegrator preintegrator;
    preintegrator.config.angular_acceleration = 2;
    const PreintegratedImu imu = preintegrator.integrate(request);
    const double duration = toSeconds(kEnd);
    // A constant angular acceleration of one sigma changes the rate by as much as the walk does.
    EXPECT_NEAR(imu.rate_walk * duration, square(2 * duration), 1e-12);

    Random random(4);
    Eigen::Matrix<double, 6, 6> scatter = Eigen::Matrix<double, 6, 6>::Zero();
    constexpr int runs = 4000, steps = 50;
    const double dt = duration / steps;
    for (int run = 0; run < runs; run++)
    {
        NavState current = request.previous;
        current.t = kEnd;
        Vector3d rate = request.previous_rate;
        for (int i = 0; i < steps; i++)
        {
            const Vector3d change = random.vector(std::sqrt(imu.rate_walk * dt));
            current.T_world_imu.R = current.T_world_imu.R * expSO3((rate + 0.5 * change) * dt);
            rate += change;
        }
        current.bias_gyro = request.previous.bias_gyro - (rate - request.previous_rate);
        const NavState::Vector r = imuResidual(imu, request.previous, current);
        Eigen::Matrix<double, 6, 1> e;
        e << r.segment<3>(NavState::kRotation), r.segment<3>(NavState::kBiasGyro);
        scatter += e * e.transpose() / runs;
    }
    const NavState::Matrix P = imuCovariance(imu);
    Eigen::Matrix<double, 6, 6> claimed;
    claimed << P.block<3, 3>(NavState::kRotation, NavState::kRotation),
        P.block<3, 3>(NavState::kRotation, NavState::kBiasGyro),
        P.block<3, 3>(NavState::kBiasGyro, NavState::kRotation),
        P.block<3, 3>(NavState::kBiasGyro, NavState::kBiasGyro);
    const Eigen::Matrix<double, 6, 6> L = claimed.llt().matrixL();
    const Eigen::Matrix<double, 6, 6> half = L.triangularView<Eigen::Lower>().solve(scatter);
    const Eigen::Matrix<double, 6, 6> whitened =
        L.triangularView<Eigen::Lower>().solve(half.transpose());
    EXPECT_LT((whitened - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff(), 0.12);
}

TEST(ImuFactor, CovarianceIsThatOfManyNoisyResiduals)
{
    SteadyTurn body;
    body.rate *= 3;  // so that gamma, which turns the error of the rotation, is not near identity
    const Duration period = 5 * kMillisecond / 2;
    const ImuSamples clean = body.samples(0, kEnd, period);
    const ImuNoise noise{0.01, 0.1, 2e-3, 3e-2};
    const NavState previous = body.at(0);
    const PreintegratedImu truth = integrate(body, clean, noise);
    const NavState current = predict(truth, previous);

    Random random(3);
    ImuSamples noisy = clean;
    Eigen::Matrix<double, 9, 9> scatter = Eigen::Matrix<double, 9, 9>::Zero();
    constexpr int runs = 3000;
    const double root = std::sqrt(toSeconds(period));
    for (int run = 0; run < runs; run++)
    {
        for (std::size_t i = 0; i < clean.size(); i++)
        {
            noisy[i].gyro = clean[i].gyro + random.vector(noise.gyro / root);
            noisy[i].accel = clean[i].accel + random.vector(noise.accel / root);
        }
        const Eigen::Matrix<double, 9, 1> e =
            imuResidual(integrate(body, noisy), previous, current).head<9>();
        scatter += e * e.transpose() / runs;
    }
    const NavState::Matrix claimed = imuCovariance(truth);
    const Eigen::Matrix<double, 9, 9> L =
        Eigen::Matrix<double, 9, 9>(claimed.topLeftCorner<9, 9>()).llt().matrixL();
    const Eigen::Matrix<double, 9, 9> half = L.triangularView<Eigen::Lower>().solve(scatter);
    const Eigen::Matrix<double, 9, 9> whitened =
        L.triangularView<Eigen::Lower>().solve(half.transpose());
    EXPECT_LT((whitened - Eigen::Matrix<double, 9, 9>::Identity()).cwiseAbs().maxCoeff(), 0.12);
    EXPECT_NEAR(claimed(NavState::kBiasAccel, NavState::kBiasAccel), 9e-4 * 0.1, 1e-12);
    EXPECT_NEAR(claimed(NavState::kBiasGyro, NavState::kBiasGyro), 4e-6 * 0.1, 1e-12);
}
