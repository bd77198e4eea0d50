#include "taut/odometry/weakDirections.h"

#include <gtest/gtest.h>

#include "numeric.h"

namespace taut
{
namespace
{
using test::Random;

constexpr double kNormalError = 0.05;

/** Matches with planes of one normal, each normal wrong by a random angle. */
struct Matches
{
    void add(int count, const Vector3d& normal, double error)
    {
        for (int i = 0; i < count; i++)
        {
            Correspondence c;
            c.surface = Surface::Plane;
            c.direction = (normal + random.vector(error)).normalized();
            c.point = random.vector(5);
            c.sigma = 0.02;
            planes.push_back(c);
            queries.push_back({c.point + random.vector(0.3), FeatureKind::Any, normal});
        }
    }

    double residual(std::size_t i, const std::vector<Correspondence>& of) const
    {
        return of[i].direction.dot(queries[i].position - of[i].point);
    }

    std::vector<Correspondence> corrected(double normal_error = kNormalError) const
    {
        std::vector<Correspondence> c = planes;
        removeNormalErrors(queries, normal_error, c);
        return c;
    }

    Random random{5};
    std::vector<MapPoint> queries;
    std::vector<Correspondence> planes;
};

/** Sum of (n . u)^2: what the normals say of the direction u. */
double knowledge(const std::vector<Correspondence>& planes, const Vector3d& u)
{
    double sum = 0;
    for (const Correspondence& c : planes) sum += square(c.direction.dot(u));
    return sum;
}
}  // namespace

TEST(RemoveNormalErrors, AWallSaysNothingOfTheDirectionsAlongIt)
{
    const Vector3d normal = Vector3d(1, 2, -0.5).normalized();
    const Vector3d along = normal.unitOrthogonal();
    Matches wall;
    wall.add(500, normal, 0.01);
    EXPECT_GT(knowledge(wall.planes, along), 0.01);
    const std::vector<Correspondence> corrected = wall.corrected();
    // What is left is the error of the mean normal.
    EXPECT_LT(knowledge(corrected, along), 0.02 * knowledge(wall.planes, along));
    EXPECT_NEAR(knowledge(corrected, normal), 500, 0.5);
}

TEST(RemoveNormalErrors, ResidualsStay)
{
    Matches scene;
    scene.add(200, Vector3d::UnitX(), 0.02);
    scene.add(100, Vector3d::UnitZ(), 0.02);
    const std::vector<Correspondence> corrected = scene.corrected();
    for (std::size_t i = 0; i < corrected.size(); i++)
    {
        EXPECT_NEAR(corrected[i].direction.norm(), 1, 1e-12);
        EXPECT_NEAR(
            scene.residual(i, corrected), scene.residual(i, scene.planes),
            0.01 * std::abs(scene.residual(i, scene.planes)));
    }
}

TEST(RemoveNormalErrors, FewPlanesThatFaceADirectionAreNotTouched)
{
    Matches corridor;
    corridor.add(1000, Vector3d::UnitY(), 0.01);
    corridor.add(500, Vector3d::UnitZ(), 0.01);
    corridor.add(8, Vector3d(1, 0, 0), 0);  // reveals of doors
    EXPECT_NEAR(knowledge(corridor.corrected(), Vector3d::UnitX()), 8, 0.01);
}

TEST(RemoveNormalErrors, NoErrorNoChangeAndLinesAreLeftAlone)
{
    Matches scene;
    scene.add(100, Vector3d::UnitY(), 0.02);
    scene.planes[3].surface = Surface::Line;
    scene.planes[4].surface = Surface::None;
    const std::vector<Correspondence> same = scene.corrected(0), corrected = scene.corrected();
    for (std::size_t i = 0; i < same.size(); i++)
        EXPECT_LT((same[i].direction - scene.planes[i].direction).norm(), 1e-12);
    for (const std::size_t i : {3, 4})
    {
        EXPECT_EQ(corrected[i].direction, scene.planes[i].direction);
        EXPECT_EQ(corrected[i].point, scene.planes[i].point);
    }
}
}  // namespace taut
