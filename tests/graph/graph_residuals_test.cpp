#include "taut/graph/GraphResiduals.h"

#include <gtest/gtest.h>

#include "graphs.h"

using namespace taut;
using namespace taut::test;

TEST(RelativeResidual, IsTheTangentOfTheGapInTheFrameOfTo)
{
    Random random(1);
    for (int i = 0; i < 20; i++)
    {
        const Pose from = anyPose(random, 5, 1), measured = anyPose(random, 2, 1);
        const Vector6d d = noise(random, tangent(0.5, 0.5));
        EXPECT_TRUE(relativeResidual(measured, from, from * measured * exp(d)).isApprox(d, 1e-12));
    }
}

TEST(RelativeResidual, JacobiansAreTheNumericOnes)
{
    Random random(2);
    for (int i = 0; i < 50; i++)
    {
        const Pose z = anyPose(random, 2, 1), from = anyPose(random, 5, 1);
        // From no residual to one of more than two radians.
        const Pose to = from * z * exp(noise(random, tangent(0.1 * i, 0.015 * i)));
        const auto l = linearizeRelative(z, from, to);
        ASSERT_LT((l.residual - relativeResidual(z, from, to)).norm(), 1e-12);
        const auto by_from = numericJacobian(
            [&](const Eigen::VectorXd& d) { return relativeResidual(z, perturbed(from, d), to); },
            6);
        const auto by_to = numericJacobian(
            [&](const Eigen::VectorXd& d) { return relativeResidual(z, from, perturbed(to, d)); },
            6);
        const double scale = 1 + (to.p - from.p).norm();
        EXPECT_LT((l.by_from - by_from).cwiseAbs().maxCoeff(), 1e-8 * scale) << i;
        EXPECT_LT((l.by_to - by_to).cwiseAbs().maxCoeff(), 1e-8 * scale) << i;
    }
}

TEST(GravityResidual, IsTheRotationByWhichTheSubmapIsTurnedTooFar)
{
    Random random(3);
    for (int i = 0; i < 20; i++)
    {
        const Matrix3d R = expSO3(random.vector(1));
        const Vector3d up = R.transpose().col(2);
        Vector3d tilt = random.vector(0.5);
        tilt -= tilt.dot(up) * up;
        const Vector3d r = gravityResidual(up, R * expSO3(tilt));
        EXPECT_LT((r - tilt).norm(), 1e-12);
        const Matrix3d turned = expSO3({0, 0, 1.0}) * R * expSO3(tilt);  // yaw changes nothing
        EXPECT_LT((gravityResidual(up, turned) - r).norm(), 1e-12);
    }
}

TEST(GravityResidual, JacobianIsTheNumericOne)
{
    Random random(4);
    for (int i = 0; i < 60; i++)
    {
        const Vector3d up = random.vector(1).normalized();
        const Vector3d axis = up.cross(random.vector(1)).normalized();
        const Matrix3d level =
            Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix();
        const double angle = i < 10 ? 3e-4 * i : 0.05 * i;  // to 2.95 rad
        const Matrix3d R = expSO3({0, 0, random.uniform(-3, 3)}) * level * expSO3(angle * axis);
        const auto l = linearizeGravity(up, R);
        EXPECT_NEAR(l.residual.norm(), angle, 1e-9);
        const auto numeric = numericJacobian(
            [&](const Eigen::VectorXd& d) { return gravityResidual(up, R * expSO3(Vector3d(d))); },
            3);
        // Near pi the axis turns fast, and the third derivative with it.
        EXPECT_LT((l.by_rotation - numeric).cwiseAbs().maxCoeff(), angle < 2 ? 1e-8 : 1e-4) << i;
    }
}

TEST(GravityResidual, UpsideDownIsHalfATurn)
{
    for (const Vector3d& up : {Vector3d(0, 0, -1), Vector3d(1e-12, 0, -1)})
    {
        const auto l = linearizeGravity(up, Matrix3d::Identity());
        EXPECT_NEAR(l.residual.norm(), M_PI, 1e-12);
        EXPECT_NEAR(l.residual.dot(up), 0, 1e-12);
        EXPECT_TRUE(l.by_rotation.allFinite());
        // Turned back about the residual, it is level.
        const Matrix3d R = expSO3(-0.1 * l.residual.normalized());
        EXPECT_NEAR(gravityResidual(up, R).norm(), M_PI - 0.1, 1e-9);
    }
}
