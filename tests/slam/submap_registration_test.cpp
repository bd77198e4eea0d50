#include "taut/loops/SubmapRegistration.h"

#include <gtest/gtest.h>

#include "walks.h"

using namespace taut;
using namespace taut::test;

TEST(ThePlaneResidual, HasTheNumericDerivative)
{
    Random random(7);
    for (int i = 0; i < 50; i++)
    {
        const Pose T{expSO3(random.vector(1)), random.vector(5)};
        const Vector3d x = random.vector(10);
        Correspondence plane;
        plane.surface = Surface::Plane;
        plane.direction = random.vector(1).normalized();
        plane.point = random.vector(5);
        const auto residual = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd
        {
            const Pose moved = T * Pose{expSO3(d.tail<3>()), d.head<3>()};
            return Eigen::VectorXd::Constant(1, planeResidual(moved, x, plane).residual);
        };
        const Vector6d numeric = numericJacobian(residual, 6).transpose();
        EXPECT_LT((numeric - planeResidual(T, x, plane).derivative).norm(), 1e-7);
    }
}

TEST(TwoSubmapsOfOnePlace, AreRegisteredFromAside)
{
    const Submap a = submapOf(ring(), aroundRing, 10, 15, 1);
    const Submap b = submapOf(ring(), aroundRing, 14, 15, 2);
    const Pose truth = a.T_world_submap.inverse() * b.T_world_submap;
    OctreeMap map;
    Executor executor;
    map.insert(mapPointsOf(a, a.points.size()), executor);
    SubmapRegistration registration(map, executor);
    const std::vector<MapPoint> points = mapPointsOf(b, 2500);
    for (const double side : {-1.0, 1.0})
    {
        const Pose aside{expSO3({0, 0, 0.04 * side}), {0.3 * side, -0.2, 0.1}};
        const SubmapFit fit = registration.align(points, truth * aside, 0.5);
        EXPECT_TRUE(fit.converged);
        EXPECT_LT((fit.T_from_to.p - truth.p).norm(), 0.01);
        EXPECT_LT(logSO3(fit.T_from_to.R.transpose() * truth.R).norm(), 0.001);
        EXPECT_GT(fit.share(points.size()), 0.6);
    }
}
