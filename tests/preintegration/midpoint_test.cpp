#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "steady_turn.h"
#include "taut/factors/ImuFactor.h"
#include "taut/preintegration/MidpointPreintegrator.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kSweep = 100 * kMillisecond;

PreintegrationRequest request(
    const ImuSamples& samples, const NavState& previous, Time begin, Time end)
{
    PreintegrationRequest r;
    r.begin = begin;
    r.end = end;
    r.samples = &samples;
    r.previous = previous;
    r.noise = {2e-3, 2e-2, 1e-4, 1e-3};
    return r;
}

PreintegratedImu integrate(
    const SteadyTurn& body, Time begin, Time end, Duration period,
    const MidpointConfig& config = {})
{
    MidpointPreintegrator preintegrator;
    preintegrator.config = config;
    const ImuSamples samples = body.samples(begin - 3 * period, end + period, period);
    return preintegrator.integrate(request(samples, body.at(begin), begin, end));
}

/** Largest difference of alpha [m], beta [m/s] or gamma [rad]. */
double difference(const Motion& a, const Motion& b)
{
    return std::max(
        {(a.alpha - b.alpha).norm(), (a.beta - b.beta).norm(),
         logSO3(a.gamma.transpose() * b.gamma).norm()});
}

Eigen::Matrix<double, 9, 1> errorOf(const MotionDelta& measured, const MotionDelta& truth)
{
    Eigen::Matrix<double, 9, 1> e;
    e << measured.alpha - truth.alpha, measured.beta - truth.beta,
        logSO3(truth.gamma.transpose() * measured.gamma);
    return e;
}
}  // namespace

TEST(MidpointPreintegrator, FollowsTheClosedFormWithAnErrorOfSecondOrder)
{
    SteadyTurn body;
    body.sway = 0.8;
    const MotionDelta truth = body.motion(kSweep, 0);
    const double coarse =
        difference(integrate(body, 0, kSweep, 10 * kMillisecond).knots.back().delta, truth);
    const double fine =
        difference(integrate(body, 0, kSweep, 5 * kMillisecond).knots.back().delta, truth);
    const double finest =
        difference(integrate(body, 0, kSweep, kMillisecond).knots.back().delta, truth);
    EXPECT_GT(coarse, 1e-6);  // there is an error to halve
    EXPECT_NEAR(coarse / fine, 4, 0.2);
    EXPECT_NEAR(coarse / finest, 100, 5);
}

TEST(MidpointPreintegrator, IsExactForAConstantRateAndAcceleration)
{
    const SteadyTurn body;
    const PreintegratedImu chain = integrate(body, 0, kSweep, 10 * kMillisecond);
    for (const ImuKnot& knot : chain.knots)
        EXPECT_LT(difference(knot.delta, body.motion(kSweep, knot.sample.t)), 1e-12);
}

TEST(MidpointPreintegrator, KeepsABodyAtRest)
{
    const SteadyTurn body = SteadyTurn::rest();
    const PreintegratedImu chain = integrate(body, 0, kSweep, 5 * kMillisecond);
    const MotionDelta& start = chain.knots.back().delta;
    const double d = toSeconds(kSweep);
    const Vector3d g = body.T_world_imu.R.transpose() * kGravityWorld;
    EXPECT_LT(
        (start.alpha - 0.5 * g * d * d).norm(), 1e-12);  // the sign of gravity: docs/equations.md
    EXPECT_LT((start.beta + g * d).norm(), 1e-12);
    EXPECT_LT((start.gamma - Matrix3d::Identity()).norm(), 1e-12);

    const NavState after = predict(chain, body.at(0));
    EXPECT_LT((after.T_world_imu.p - body.T_world_imu.p).norm(), 1e-12);
    EXPECT_LT(after.v_world.norm(), 1e-12);
    EXPECT_EQ(after.t, kSweep);
}

TEST(MidpointPreintegrator, PredictsTheClosedForm)
{
    SteadyTurn body;
    body.sway = 0.8;
    const NavState predicted = predict(integrate(body, 0, kSweep, kMillisecond), body.at(0));
    EXPECT_LT(predicted.localFrom(body.at(kSweep)).norm(), 2e-5);
}

TEST(MidpointPreintegrator, InterpolatesAtBothEnds)
{
    // The ends fall between samples: what matters is that no part of a step is lost.
    const SteadyTurn body;
    MidpointPreintegrator preintegrator;
    const Duration period = 4 * kMillisecond;
    const ImuSamples samples = body.samples(0, kSweep + period, period);
    const Time begin = 5'700'000, end = 98'300'000;
    const PreintegratedImu chain =
        preintegrator.integrate(request(samples, body.at(begin), begin, end));
    EXPECT_EQ(chain.begin(), begin);
    EXPECT_EQ(chain.end(), end);
    EXPECT_LT((chain.knots.front().sample.accel - body.sample(end).accel).norm(), 1e-3);
    EXPECT_LT((chain.knots.back().sample.accel - body.sample(begin).accel).norm(), 1e-3);
    EXPECT_LT(difference(chain.knots.back().delta, body.motion(end, begin)), 2e-5);
}

TEST(MidpointPreintegrator, HoldsTheNearestSampleBeyondTheEnds)
{
    const SteadyTurn body = SteadyTurn::rest();
    MidpointPreintegrator preintegrator;
    const ImuSamples samples = body.samples(30 * kMillisecond, 60 * kMillisecond, kMillisecond);
    const PreintegratedImu chain = preintegrator.integrate(request(samples, body.at(0), 0, kSweep));
    EXPECT_LT(difference(chain.knots.back().delta, body.motion(kSweep, 0)), 1e-9);
}

TEST(MidpointPreintegrator, IntegratesAnIntervalWithinOneStep)
{
    const SteadyTurn body;
    MidpointPreintegrator preintegrator;
    const ImuSamples samples = body.samples(0, 20 * kMillisecond, 10 * kMillisecond);
    const Time begin = 2 * kMillisecond, end = 7 * kMillisecond;
    const PreintegratedImu chain =
        preintegrator.integrate(request(samples, body.at(begin), begin, end));
    EXPECT_EQ(chain.knots.size(), 2u);
    EXPECT_LT(difference(chain.knots.back().delta, body.motion(end, begin)), 1e-5);
}

TEST(MidpointPreintegrator, GivesTheMotionAtAnyTimeAsIfIntegratedToThere)
{
    const SteadyTurn body;
    const Duration period = 7 * kMillisecond;
    MidpointPreintegrator preintegrator;
    const ImuSamples samples = body.samples(-period, kSweep + period, period);
    const PreintegratedImu chain = preintegrator.integrate(request(samples, body.at(0), 0, kSweep));
    Random random(1);
    std::size_t hint = 0, value_hint = 0;
    for (int i = 0; i < 200; i++)
    {
        const Time t = static_cast<Time>(random.uniform(0, kSweep - 1.0));
        const PreintegratedImu part =
            preintegrator.integrate(request(samples, body.at(t), t, kSweep));
        const MotionDelta& expected = part.knots.back().delta;
        const MotionDelta found = chain.at(t, hint);
        EXPECT_LT(difference(found, expected), 1e-12);
        EXPECT_LT((found.dalpha_dba - expected.dalpha_dba).norm(), 1e-12);
        EXPECT_LT((found.dbeta_dbg - expected.dbeta_dbg).norm(), 1e-12);
        EXPECT_LT((found.dtheta_dbg - expected.dtheta_dbg).norm(), 1e-12);
        EXPECT_EQ(difference(found, chain.at(t)), 0);  // whatever the hint
        EXPECT_LT(difference(chain.valueAt(t, value_hint), expected), 1e-12);
    }
    EXPECT_EQ(difference(chain.at(kSweep), MotionDelta{}), 0);
    EXPECT_EQ(difference(chain.at(0), chain.knots.back().delta), 0);
}

TEST(MidpointPreintegrator, DerivativesByTheBiasesAreThoseOfAStep)
{
    Random random(2);
    for (int i = 0; i < 20; i++)
    {
        // Two steps, so that the derivatives of the first go through the second.
        const ImuSample later{30 * kMillisecond, random.vector(5), random.vector(20)},
            middle{18 * kMillisecond, random.vector(5), random.vector(20)},
            earlier{0, random.vector(5), random.vector(20)};
        const Vector3d bias_accel = random.vector(0.3), bias_gyro = random.vector(0.1);
        const auto motion = [&](const Vector3d& dba, const Vector3d& dbg)
        {
            const Vector3d ba = bias_accel + dba, bg = bias_gyro + dbg;
            return stepBackward(stepBackward({}, later, middle, ba, bg), middle, earlier, ba, bg);
        };
        const MotionDelta at = motion(Vector3d::Zero(), Vector3d::Zero());
        const Eigen::MatrixXd numeric = numericJacobian(
            [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
            { return errorOf(motion(d.head<3>(), d.tail<3>()), at); },
            6);
        Eigen::Matrix<double, 9, 6> analytic;
        analytic << at.dalpha_dba, at.dalpha_dbg, at.dbeta_dba, at.dbeta_dbg, Matrix3d::Zero(),
            at.dtheta_dbg;
        EXPECT_LT((analytic - numeric).norm(), 1e-8);
    }
}

TEST(MidpointPreintegrator, CorrectsForABiasToFirstOrder)
{
    const SteadyTurn body;
    const PreintegratedImu chain = integrate(body, 0, kSweep, 2 * kMillisecond);
    const auto errorFor = [&](double size)
    {
        const Vector3d dba = size * Vector3d(1, -2, 1.5), dbg = size * Vector3d(-1, 0.5, 1);
        SteadyTurn biased = body;  // the same measurements, believed to hold other biases
        biased.bias_accel += dba;
        biased.bias_gyro += dbg;
        MidpointPreintegrator preintegrator;
        const ImuSamples samples = body.samples(0, kSweep, 2 * kMillisecond);
        const MotionDelta exact =
            preintegrator.integrate(request(samples, biased.at(0), 0, kSweep)).knots.back().delta;
        const PreintegratedImu corrected =
            chain.correctedForBias(biased.bias_accel, biased.bias_gyro);
        EXPECT_EQ(corrected.bias_accel, biased.bias_accel);
        EXPECT_EQ(
            difference(
                corrected.knots.back().delta,
                correctedForBias(
                    chain.knots.back().delta, biased.bias_accel - chain.bias_accel,
                    biased.bias_gyro - chain.bias_gyro)),
            0);
        EXPECT_GT(difference(chain.knots.back().delta, exact), 0.05 * size);
        return difference(corrected.knots.back().delta, exact);
    };
    EXPECT_LT(errorFor(0.1), 1e-3);
    EXPECT_NEAR(errorFor(0.1) / errorFor(0.05), 4, 0.3);
}

TEST(MidpointPreintegrator, CovarianceIsThatOfManyNoisyMeasurements)
{
    const SteadyTurn body;
    const Duration period = 5 * kMillisecond / 2;
    const ImuSamples clean = body.samples(0, kSweep, period);
    MidpointPreintegrator preintegrator;
    preintegrator.config.gyro_scale_error = preintegrator.config.accel_scale_error = 0;
    PreintegrationRequest r = request(clean, body.at(0), 0, kSweep);
    r.noise = {0.01, 0.1, 2e-3, 3e-2};
    const PreintegratedImu truth = preintegrator.integrate(r);

    Random random(3);
    ImuSamples noisy = clean;
    r.samples = &noisy;
    Eigen::Matrix<double, 9, 9> scatter = Eigen::Matrix<double, 9, 9>::Zero();
    constexpr int runs = 3000;
    const double root = std::sqrt(toSeconds(period));
    for (int run = 0; run < runs; run++)
    {
        for (std::size_t i = 0; i < clean.size(); i++)
        {
            noisy[i].gyro = clean[i].gyro + random.vector(r.noise.gyro / root);
            noisy[i].accel = clean[i].accel + random.vector(r.noise.accel / root);
        }
        const auto e =
            errorOf(preintegrator.integrate(r).knots.back().delta, truth.knots.back().delta);
        scatter += e * e.transpose() / runs;
    }
    // Whitened by what is claimed, the scatter must be the identity.
    const Eigen::Matrix<double, 9, 9> L = truth.covariance.llt().matrixL();
    const Eigen::Matrix<double, 9, 9> half = L.triangularView<Eigen::Lower>().solve(scatter);
    const Eigen::Matrix<double, 9, 9> whitened =
        L.triangularView<Eigen::Lower>().solve(half.transpose());
    EXPECT_LT((whitened - Eigen::Matrix<double, 9, 9>::Identity()).cwiseAbs().maxCoeff(), 0.12);

    const double duration = toSeconds(kSweep);
    EXPECT_NEAR(truth.bias_walk_covariance(1, 1), 9e-4 * duration, 1e-12);
    EXPECT_NEAR(truth.bias_walk_covariance(5, 5), 4e-6 * duration, 1e-12);
}

TEST(MidpointPreintegrator, ScaleErrorsGrowWithTheMotion)
{
    const SteadyTurn still = SteadyTurn::rest(), turning;
    const auto angle = [](const PreintegratedImu& c) { return c.covariance(8, 8); };
    MidpointConfig exact;
    exact.gyro_scale_error = exact.accel_scale_error = 0;
    const double white = angle(integrate(turning, 0, kSweep, kMillisecond, exact));
    const double with_scale = angle(integrate(turning, 0, kSweep, kMillisecond));
    const double expected = MidpointConfig().gyro_scale_error *
                            (turning.rate + turning.bias_gyro).norm() * toSeconds(kSweep);
    EXPECT_NEAR(std::sqrt(with_scale - white), expected, 0.01 * expected);
    EXPECT_LT(angle(integrate(still, 0, kSweep, kMillisecond)), 1.01 * white);
}

TEST(MidpointPreintegrator, AGapInTheSamplesInflatesTheCovariance)
{
    const SteadyTurn body;
    MidpointPreintegrator preintegrator;
    ImuSamples samples = body.samples(0, kSweep, 2 * kMillisecond);
    const auto covariance = [&]
    {
        return Eigen::Matrix<double, 9, 9>(
            preintegrator.integrate(request(samples, body.at(0), 0, kSweep)).covariance);
    };
    const auto complete = covariance();
    samples.erase(samples.begin() + 15, samples.begin() + 35);  // 42 ms
    for (const double share : {1.0, 0.5})
    {
        preintegrator.config.gap_time = 0.042 / share;
        const auto with_gap = covariance();
        EXPECT_GT(with_gap(8, 8), 10 * complete(8, 8));
        EXPECT_GT(with_gap(3, 3), 10 * complete(3, 3));
        // One standard deviation is what the unknown motion may do in the gap.
        const double turn = preintegrator.config.gap_rate * share * share * 0.042;
        EXPECT_NEAR(std::sqrt(with_gap(8, 8)), turn, 0.1 * turn);
    }
}

TEST(MidpointPreintegrator, AGapOverWhichTheRateChangedIsTheLessCertain)
{
    const auto turned = [](double change)
    {
        ImuSamples samples;
        for (const Time t : {0, 10, 60, 70})
        {
            ImuSample s;
            s.t = t * kMillisecond;
            s.gyro = {0, 0, t > 30 ? change : 0};
            s.accel = kGravityWorld;
            samples.push_back(s);
        }
        MidpointPreintegrator preintegrator;
        preintegrator.config.gyro_scale_error = 0;
        const auto chain =
            preintegrator.integrate(request(samples, NavState(), 0, 70 * kMillisecond));
        return chain.covariance(8, 8);
    };
    // A Brownian bridge over 50 ms that starts and ends at what was measured.
    EXPECT_NEAR(turned(2) - turned(0), square(2 * 0.05) / 12, 1e-6);
}

TEST(MidpointPreintegrator, AGapOfAWholeSweepLeavesEveryDirectionItsOwnUncertainty)
{
    // One step: its position must not be tied to its velocity.
    const PreintegratedImu chain = integrate(SteadyTurn(), 0, kSweep, kSweep);
    ASSERT_EQ(chain.knots.size(), 2u);
    const Eigen::Matrix<double, 9, 1> sigma = chain.covariance.diagonal().cwiseSqrt();
    const Eigen::Matrix<double, 9, 9> correlation =
        sigma.asDiagonal().inverse() * chain.covariance * sigma.asDiagonal().inverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(correlation);
    EXPECT_GT(eigen.eigenvalues()[0], 0.01);
    // Of white noise in the acceleration: variance of the position S dt^3 / 3, covariance with the
    // velocity S dt^2 / 2.
    EXPECT_NEAR(correlation(0, 3), -std::sqrt(3) / 2, 0.01);
}

TEST(MidpointPreintegrator, RefusesToIntegrateNothing)
{
    const SteadyTurn body;
    const MidpointPreintegrator preintegrator;
    const ImuSamples none;
    PreintegrationRequest r = request(none, body.at(0), 0, kSweep);
    EXPECT_THROW(preintegrator.integrate(r), std::invalid_argument);
    r.samples = nullptr;
    EXPECT_THROW(preintegrator.integrate(r), std::invalid_argument);
}
