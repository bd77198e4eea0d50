#include "taut/factors/SweepPath.h"

#include <gtest/gtest.h>

#include <ostream>

#include "steady_turn.h"
#include "taut/factors/ImuFactor.h"
#include "taut/preintegration/ConstantVelocityPreintegrator.h"
#include "taut/preintegration/MidpointPreintegrator.h"

namespace taut
{
void PrintTo(Undistortion mode, std::ostream* out)
{
    *out << nameOf(mode);
}
}  // namespace taut

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kEnd = 100 * kMillisecond;
constexpr Undistortion kModes[] = {Undistortion::None,     Undistortion::Rotation,
                                   Undistortion::Imu,      Undistortion::IteratedImu,
                                   Undistortion::Iterated, Undistortion::Bridge};

PreintegratedImu integrate(
    const SteadyTurn& body, Duration period = 2 * kMillisecond, bool hides = false)
{
    ImuSamples samples = body.samples(0, kEnd, period);
    for (ImuSample& s : samples)  // the middle third is at the limit of the gyro
        s.gyro_hidden = hides && s.t > kEnd / 3 && s.t < 2 * kEnd / 3 ? 2 : 0;
    PreintegrationRequest request;
    request.end = kEnd;
    request.samples = &samples;
    request.previous = body.at(0);
    return MidpointPreintegrator().integrate(request);
}

/** The chain of a body whose rate nothing measures. */
PreintegratedImu withoutImu(const SteadyTurn& body)
{
    PreintegrationRequest request;
    request.end = kEnd;
    request.previous = body.at(0);
    request.previous_rate = body.rate;
    return ConstantVelocityPreintegrator().integrate(request);
}

Pose poseAt(const SweepPath& path, Time t)
{
    std::size_t hint = 0;
    return path.poseAt(t, hint);
}

double distance(const Pose& a, const Pose& b)
{
    return (a.p - b.p).norm() + logSO3(a.R.transpose() * b.R).norm();
}

/** A body that moves like few do: what the path must hold for at the least. */
SteadyTurn violent(Random& random)
{
    SteadyTurn body;
    body.T_world_imu = {expSO3(random.vector(1)), random.vector(5)};
    body.v_world = random.vector(4);
    body.rate = 10 * random.vector(1).normalized();
    body.acceleration = random.vector(10);
    return body;
}

/** Velocity on a path, by differences [m/s]. */
Vector3d velocityAt(const SweepPath& path, Time t, Duration step)
{
    return (poseAt(path, t + step).p - poseAt(path, t).p) / toSeconds(step);
}

class AnyMode : public ::testing::TestWithParam<Undistortion>
{
};
}  // namespace

TEST_P(AnyMode, JacobianIsThatOfThePose)
{
    Random random(1);
    for (int i = 0; i < 12; i++)
    {
        const SteadyTurn body = violent(random);
        const PreintegratedImu imu =
            i % 4 == 3 ? withoutImu(body) : integrate(body, 2 * kMillisecond, i % 4 == 0);
        const double gap = i < 6 ? 0.02 : 0.6;  // both ends off by so many m, m/s and rad
        const NavState previous = disturbed(body.at(0), random, gap);
        const NavState current = disturbed(body.at(kEnd), random, gap);
        SweepPath path(GetParam(), imu, body.at(0), body.at(kEnd));
        for (const double share : {0.0, 0.03, 0.5, 0.77, 1.0})
        {
            const Time t = static_cast<Time>(share * kEnd);
            path.setStates(previous, current);
            std::size_t hint = 0;
            PathJacobian J;
            const Pose at = path.poseAt(t, hint, J);
            EXPECT_LT(distance(at, poseAt(path, t)), 1e-12);
            const Eigen::MatrixXd numeric = numericJacobian(
                [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
                {
                    path.setStates(
                        previous.retract(d.head<NavState::kSize>()),
                        current.retract(d.tail<NavState::kSize>()));
                    const Pose moved = poseAt(path, t);
                    Eigen::VectorXd e(6);
                    e << moved.p - at.p, logSO3(at.R.transpose() * moved.R);
                    return e;
                },
                2 * NavState::kSize);
            EXPECT_LT((J - numeric).cwiseAbs().maxCoeff(), 1e-7) << "at " << share;
        }
    }
}

TEST_P(AnyMode, EndsAtTheCurrentState)
{
    Random random(2);
    const SteadyTurn body = violent(random);
    const PreintegratedImu imu = integrate(body);
    SweepPath path(GetParam(), imu, body.at(0), body.at(kEnd));
    const NavState current = disturbed(body.at(kEnd), random, 0.5);
    path.setStates(disturbed(body.at(0), random, 0.5), current);
    EXPECT_LT(distance(poseAt(path, kEnd), current.T_world_imu), 1e-12);
}

TEST_P(AnyMode, NameIsReadBack)
{
    ConfigSection section(parseYaml(std::string("undistortion: ") + nameOf(GetParam())));
    Undistortion mode = GetParam() == Undistortion::None ? Undistortion::Imu : Undistortion::None;
    declareUndistortion(section, mode);
    EXPECT_EQ(mode, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyMode, ::testing::ValuesIn(kModes),
    [](const auto& test)
    {
        std::string name = nameOf(test.param);
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

TEST(SweepPath, FollowsTheTrueMotionWhereBothEndsAreTrue)
{
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body, kMillisecond);
    for (const Undistortion mode :
         {Undistortion::Imu, Undistortion::IteratedImu, Undistortion::Iterated,
          Undistortion::Bridge})
    {
        const SweepPath path(mode, imu, body.at(0), body.at(kEnd));
        for (Time t = 0; t <= kEnd; t += kEnd / 17)
            EXPECT_LT(distance(poseAt(path, t), body.at(t).T_world_imu), 1e-5) << nameOf(mode);
    }
}

TEST(SweepPath, CorrectedPathsBeginAtThePreviousState)
{
    // The path meets both states (docs/equations.md), with gaps far beyond any real one.
    Random random(3);
    for (int i = 0; i < 10; i++)
    {
        const SteadyTurn body = violent(random);
        const PreintegratedImu imu = integrate(body);
        const NavState previous = disturbed(body.at(0), random, 0.5);
        const NavState current = disturbed(body.at(kEnd), random, 0.5);
        for (const Undistortion mode : {Undistortion::Iterated, Undistortion::Bridge})
        {
            SweepPath path(mode, imu, body.at(0), body.at(kEnd));
            // Biases are corrected to first order at the knots only.
            path.setStates(previous, current);
            EXPECT_LT(distance(poseAt(path, 0), previous.T_world_imu), 1e-5);
            NavState same_biases = current;
            same_biases.bias_accel = imu.bias_accel;
            same_biases.bias_gyro = imu.bias_gyro;
            path.setStates(previous, same_biases);
            EXPECT_LT(distance(poseAt(path, 0), previous.T_world_imu), 1e-10);
        }
    }
}

TEST(SweepPath, WithoutAGapTheCorrectedPathsAreTheApriori)
{
    // Fact 2: the previous state moved to where the IMU says it was, seen from the current one.
    Random random(4);
    const SteadyTurn body = violent(random);
    const PreintegratedImu imu = integrate(body);
    NavState current = disturbed(body.at(kEnd), random, 0.3);
    const MotionDelta start =
        imu.correctedForBias(current.bias_accel, current.bias_gyro).knots.back().delta;
    const double duration = imu.duration();
    NavState previous = current;
    previous.T_world_imu.R = current.T_world_imu.R * start.gamma;
    previous.v_world =
        current.v_world + kGravityWorld * duration + current.T_world_imu.R * start.beta;
    previous.T_world_imu.p = current.T_world_imu.p - current.v_world * duration -
                             0.5 * kGravityWorld * duration * duration +
                             current.T_world_imu.R * start.alpha;

    SweepPath apriori(Undistortion::IteratedImu, imu, body.at(0), body.at(kEnd));
    apriori.setStates(previous, current);
    for (const Undistortion mode : {Undistortion::Iterated, Undistortion::Bridge})
    {
        SweepPath path(mode, imu, body.at(0), body.at(kEnd));
        path.setStates(previous, current);
        for (Time t = 0; t <= kEnd; t += kEnd / 11)
            EXPECT_LT(distance(poseAt(path, t), poseAt(apriori, t)), 1e-10) << nameOf(mode);
    }
}

TEST(SweepPath, TheVelocityCancelsFromThePapersPath)
{
    // Fact 3: the points do not tell the velocity at the end of the sweep.
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body);
    SweepPath iterated(Undistortion::Iterated, imu, body.at(0), body.at(kEnd));
    SweepPath apriori(Undistortion::IteratedImu, imu, body.at(0), body.at(kEnd));
    for (const double share : {0.2, 0.5, 0.9})
    {
        const Time t = static_cast<Time>(share * kEnd);
        const double d = toSeconds(kEnd - t);
        std::size_t hint = 0;
        PathJacobian J;
        constexpr int by_velocity = NavState::kSize + NavState::kVelocity;
        iterated.poseAt(t, hint, J);
        EXPECT_LT((J.block<3, 3>(0, by_velocity).norm()), 1e-5);
        apriori.poseAt(t, hint, J);
        EXPECT_LT((J.block<3, 3>(0, by_velocity) + d * Matrix3d::Identity()).norm(), 1e-12);
    }
}

TEST(SweepPath, WithoutRotationGravityLeavesAParabola)
{
    // Fact 3 again: a body that falls freely, so that its IMU measures nothing.
    SteadyTurn body = SteadyTurn::rest();
    body.acceleration = -kGravityWorld;
    const PreintegratedImu imu = integrate(body);
    SweepPath path(Undistortion::Iterated, imu, body.at(0), body.at(kEnd));
    const double duration = toSeconds(kEnd);
    for (const double share : {0.1, 0.4, 0.8})
    {
        const double mu = 1 - share;
        const Vector3d straight =
            mu * body.at(0).T_world_imu.p + (1 - mu) * body.at(kEnd).T_world_imu.p;
        const Vector3d rise = 0.5 * kGravityWorld * duration * duration * mu * (1 - mu);
        const Pose at = poseAt(path, static_cast<Time>(share * kEnd));
        EXPECT_LT((at.p - straight - rise).norm(), 1e-9);
    }
}

TEST(SweepPath, EarlyPointsPullLittleOnTheNewPosition)
{
    // Fact 4.
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body);
    const SweepPath path(Undistortion::Iterated, imu, body.at(0), body.at(kEnd));
    for (const double mu : {0.0, 0.25, 0.8, 1.0})
    {
        std::size_t hint = 0;
        PathJacobian J;
        path.poseAt(static_cast<Time>((1 - mu) * kEnd), hint, J);
        const Matrix3d by_p = J.block<3, 3>(0, NavState::kSize + NavState::kPosition);
        const Matrix3d by_p0 = J.block<3, 3>(0, NavState::kPosition);
        EXPECT_LT((by_p - (1 - mu) * Matrix3d::Identity()).norm(), 1e-7);
        EXPECT_LT((by_p0 - mu * Matrix3d::Identity()).norm(), 1e-7);
    }
}

TEST(SweepPath, TheBridgeClosesTheVelocityGapToo)
{
    Random random(5);
    for (int i = 0; i < 5; i++)
    {
        const SteadyTurn body = violent(random);
        const PreintegratedImu imu = integrate(body, kMillisecond);
        NavState previous = body.at(0), current = body.at(kEnd);
        previous.T_world_imu.p += random.vector(0.3);
        previous.v_world += random.vector(1);
        current.T_world_imu.p += random.vector(0.3);
        current.v_world += random.vector(1);
        SweepPath path(Undistortion::Bridge, imu, body.at(0), body.at(kEnd));
        path.setStates(previous, current);
        constexpr Duration step = kMillisecond / 50;
        EXPECT_LT((velocityAt(path, 0, step) - previous.v_world).norm(), 0.03);
        EXPECT_LT((velocityAt(path, kEnd - step, step) - current.v_world).norm(), 0.03);
        EXPECT_LT((poseAt(path, 0).p - previous.T_world_imu.p).norm(), 1e-10);
    }
}

TEST(SweepPath, AGapInRotationIsClosedWhereTheGyroWasAtItsLimit)
{
    // As the covariance tells: the most probable path of a noise that is not even.
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body, kMillisecond, true);
    EXPECT_EQ(imu.gapShare(kEnd, 0), 0);
    EXPECT_NEAR(imu.gapShare(0, 0), 1, 1e-12);
    EXPECT_LT(imu.gapShare(2 * kEnd / 3 + kMillisecond, 0), 0.01);
    EXPECT_NEAR(imu.gapShare(kEnd / 2, 0), 0.5, 0.01);
    EXPECT_GT(imu.gapShare(kEnd / 3 - kMillisecond, 0), 0.99);

    NavState current = body.at(kEnd);
    current.T_world_imu.R = current.T_world_imu.R * expSO3({0, 0, 0.1});
    for (const Undistortion mode : {Undistortion::Iterated, Undistortion::Bridge})
    {
        SweepPath path(mode, imu, body.at(0), body.at(kEnd));
        path.setStates(body.at(0), current);
        const auto off = [&](Time t)
        { return logSO3(body.at(t).T_world_imu.R.transpose() * poseAt(path, t).R).norm(); };
        EXPECT_LT(off(kEnd / 4), 1e-3);
        EXPECT_NEAR(off(3 * kEnd / 4), 0.1, 1e-3);
    }
}

TEST(SweepPath, WhereNothingMeasuresTheRateThePathHasThatOfBothEnds)
{
    // A rate that changes steadily is followed exactly, but for what turns do not commute.
    Random random(8);
    for (int i = 0; i < 5; i++)
    {
        SteadyTurn body;
        body.rate = random.vector(2);
        const PreintegratedImu imu = withoutImu(body);
        const Vector3d change = random.vector(1);  // [rad/s] over the sweep
        NavState previous = body.at(0), current = previous;
        current.t = kEnd;
        const double duration = toSeconds(kEnd);
        const auto turned = [&](double s) -> Matrix3d {
            return previous.T_world_imu.R * expSO3(body.rate * s + change * (s * s / duration / 2));
        };
        current.T_world_imu.R = turned(duration);
        current.bias_gyro = previous.bias_gyro - change;  // the sample's rate stays what it is
        SweepPath path(Undistortion::Bridge, imu, previous, previous);
        path.setStates(previous, current);
        for (const double share : {0.0, 0.2, 0.5, 0.9})
        {
            const Pose at = poseAt(path, static_cast<Time>(share * kEnd));
            EXPECT_LT(logSO3(turned(share * duration).transpose() * at.R).norm(), 2e-3) << share;
        }
    }
}

TEST(SweepPath, OnePassModesKeepTheirShapeAndFollowTheNewPoseOnly)
{
    Random random(6);
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body);
    for (const Undistortion mode : {Undistortion::None, Undistortion::Rotation, Undistortion::Imu})
    {
        SweepPath path(mode, imu, body.at(0), body.at(kEnd));
        const Time t = kEnd / 3;
        const Pose before = body.at(kEnd).T_world_imu.inverse() * poseAt(path, t);
        const NavState moved = disturbed(body.at(kEnd), random, 0.5);
        path.setStates(disturbed(body.at(0), random, 0.5), moved);
        const Pose after = moved.T_world_imu.inverse() * poseAt(path, t);
        EXPECT_LT(distance(before, after), 1e-12) << nameOf(mode);
        EXPECT_FALSE(isIterated(mode));
    }
}

TEST(SweepPath, ModesWithoutMotionOrWithoutTranslation)
{
    const SteadyTurn body;
    const PreintegratedImu imu = integrate(body);
    const Pose end = body.at(kEnd).T_world_imu;
    const Time t = kEnd / 4;
    const SweepPath none(Undistortion::None, imu, body.at(0), body.at(kEnd));
    EXPECT_LT(distance(poseAt(none, t), end), 1e-12);
    const SweepPath rotation(Undistortion::Rotation, imu, body.at(0), body.at(kEnd));
    EXPECT_LT((poseAt(rotation, t).p - end.p).norm(), 1e-12);
    EXPECT_LT(logSO3(poseAt(rotation, t).R.transpose() * body.at(t).T_world_imu.R).norm(), 1e-9);
}
