#include "taut/core/Geometry.h"

#include <gtest/gtest.h>

#include "numeric.h"

using namespace taut;
using taut::test::numericJacobian;
using taut::test::Random;

TEST(Geometry, LogInvertsExpUpToPi)
{
    Random random(1);
    for (const double angle : {0.0, 1e-9, 1e-5, 1e-3, 0.1, 1.0, 2.5, 3.0, 3.1, 3.14159})
        for (int i = 0; i < 50; i++)
        {
            const Vector3d phi = random.vector(1).normalized() * angle;
            EXPECT_LT((logSO3(expSO3(phi)) - phi).norm(), 1e-9) << "angle " << angle;
        }
}

TEST(Geometry, ExpIsARotation)
{
    Random random(2);
    for (int i = 0; i < 100; i++)
    {
        const Matrix3d R = expSO3(random.vector(2));
        EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 1e-14);
        EXPECT_NEAR(R.determinant(), 1, 1e-14);
    }
}

TEST(Geometry, RightJacobianIsTheDerivativeOfExp)
{
    Random random(3);
    for (const double scale : {1e-7, 1e-4, 0.1, 1.0})
        for (int i = 0; i < 20; i++)
        {
            const Vector3d phi = random.vector(scale);
            const auto numeric = numericJacobian(
                [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
                { return logSO3(expSO3(phi).transpose() * expSO3(phi + Vector3d(d))); },
                3);
            EXPECT_LT((rightJacobianSO3(phi) - numeric).norm(), 1e-8);
            EXPECT_LT(
                (rightJacobianSO3(phi) * inverseRightJacobianSO3(phi) - Matrix3d::Identity())
                    .norm(),
                1e-12);
        }
}

TEST(Geometry, PoseComposesAndInverts)
{
    Random random(4);
    const Pose a{expSO3(random.vector(1)), random.vector(5)};
    const Pose b{expSO3(random.vector(1)), random.vector(5)};
    const Vector3d x = random.vector(3);
    EXPECT_LT(((a * b) * x - a * (b * x)).norm(), 1e-12);
    EXPECT_LT((a.inverse() * (a * x) - x).norm(), 1e-12);
}
