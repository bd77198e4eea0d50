#include <gtest/gtest.h>

#include <algorithm>

#include "surfaces.h"
#include "taut/core/Triangle.h"
#include "taut/evaluation/PointGrid.h"
#include "taut/evaluation/TrueSurface.h"

using namespace taut;

namespace
{
struct RandomPlaces
{
    std::mt19937 random{3};
    Vector3d at(double size)
    {
        std::uniform_real_distribution<double> u(-size, size);
        const double x = u(random), y = u(random);
        return {x, y, u(random)};
    }
};

/** Triangles of all shapes, long ones and such without area too. */
TriangleMesh crumpled(std::size_t count)
{
    RandomPlaces places;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < count; i++)
    {
        const Vector3d a = places.at(10);
        const double size = i % 10 == 0 ? 8 : 0.5;
        const Vector3d b = a + places.at(size);
        mesh.vertices.insert(
            mesh.vertices.end(), {a, b, i % 17 == 0 ? b : Vector3d(a + places.at(size))});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}
}  // namespace

TEST(Triangle, NearestPointIsNoFurtherThanAnyOther)
{
    RandomPlaces places;
    for (int n = 0; n < 200; n++)
    {
        const Vector3d a = places.at(1), b = places.at(1), c = places.at(1), p = places.at(2);
        const Vector3d q = nearestOnTriangle(p, a, b, c);
        double least = 1e9, on_triangle = 1e9;
        for (int i = 0; i <= 100; i++)
            for (int k = 0; k + i <= 100; k++)
            {
                const Vector3d r = a + (b - a) * i / 100 + (c - a) * k / 100;
                least = std::min(least, (r - p).norm());
                on_triangle = std::min(on_triangle, (r - q).norm());
            }
        EXPECT_LE((q - p).norm(), least + 1e-12);
        EXPECT_LT(on_triangle, 0.04);
    }
}

TEST(TrueSurface, NearestIsThatOfAllTriangles)
{
    const TriangleMesh mesh = crumpled(800);
    const TrueSurface surface(mesh);
    RandomPlaces places;
    std::uint32_t guess = TrueSurface::Nearest::kNone;
    for (int n = 0; n < 300; n++)
    {
        const Vector3d p = places.at(n % 7 == 0 ? 100 : 11);
        double least = 1e9;
        for (const auto& t : mesh.triangles)
            least = std::min(
                least, (nearestOnTriangle(
                            p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) -
                        p)
                           .norm());
        const auto nearest = surface.nearest(p);
        EXPECT_NEAR(nearest.distance, least, 1e-12);
        EXPECT_NEAR((nearest.point - p).norm(), least, 1e-12);
        EXPECT_EQ(surface.nearest(p, 1e9, guess).distance, nearest.distance);
        EXPECT_EQ(surface.nearest(p, 0.9 * least).element, TrueSurface::Nearest::kNone);
        guess = nearest.element;
    }
}

TEST(TrueSurface, OfACloudIsItsNearestPoint)
{
    RandomPlaces places;
    TriangleMesh cloud;
    for (int i = 0; i < 3000; i++) cloud.vertices.push_back(places.at(5));
    const TrueSurface surface(cloud);
    EXPECT_TRUE(surface.isCloud());
    for (int n = 0; n < 200; n++)
    {
        const Vector3d p = places.at(6);
        double least = 1e9;
        for (const Vector3d& v : cloud.vertices) least = std::min(least, (v - p).norm());
        EXPECT_NEAR(surface.nearest(p).distance, least, 1e-12);
    }
}

TEST(TrueSurface, KnowsSpacingAndNormalsOfACloud)
{
    test::Points points;
    const Vector3d n = Vector3d(1, 2, 3).normalized(), u = n.unitOrthogonal();
    test::addLattice(points, {4, 5, 6}, 3 * u, 3 * n.cross(u), 0.1);
    TriangleMesh cloud;
    for (const auto& p : points) cloud.vertices.push_back(p.cast<double>());
    const TrueSurface surface(cloud);
    EXPECT_NEAR(surface.spacing(), 0.1, 1e-5);
    EXPECT_NEAR(std::abs(surface.normalOf(440).dot(n)), 1, 1e-5);
}

TEST(TrueSurface, SamplesEvenlyByArea)
{
    TriangleMesh mesh;  // a quarter of the area is upright, and cut in many triangles
    test::addRectangle(mesh, {0, 0, 0}, {6, 0, 0}, {0, 5, 0});
    for (int i = 0; i < 100; i++)
        test::addRectangle(mesh, {0, 0, 0.02 * i}, {0, 5, 0}, {0, 0, 0.02});
    const TrueSurface surface(mesh);
    EXPECT_NEAR(surface.area(), 40, 1e-9);
    const std::vector<Vector3d> samples = surface.samples(40'000, 1);
    EXPECT_NEAR(static_cast<double>(samples.size()), 40'000, 1);
    for (int x = 0; x < 6; x++)
        for (int y = 0; y < 5; y++)
        {
            const auto in = std::count_if(
                samples.begin(), samples.end(),
                [&](const Vector3d& s)
                { return s.z() == 0 && s.x() > x && s.x() < x + 1 && s.y() > y && s.y() < y + 1; });
            EXPECT_NEAR(static_cast<double>(in), 1000, 40) << x << " " << y;
        }
    const auto low = std::count_if(
        samples.begin(), samples.end(), [](const Vector3d& s) { return s.x() == 0 && s.z() < 1; });
    EXPECT_NEAR(static_cast<double>(low), 5000, 60);
}

TEST(TrueSurface, RefusesNothing)
{
    EXPECT_THROW(TrueSurface(TriangleMesh{}), std::runtime_error);
    EXPECT_THROW(TrueSurface({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), std::runtime_error)
        << "no area";
}

TEST(PointGrid, FindsAllNeighbours)
{
    RandomPlaces places;
    test::Points points;
    for (int i = 0; i < 2000; i++) points.push_back(places.at(3).cast<float>());
    points.push_back({3e9F, 0, 0});  // beyond the last cell
    const PointGrid grid(points, 0.4);
    EXPECT_EQ(grid.points().size(), points.size());
    EXPECT_TRUE(grid.hasWithin({3e9, 0.1, 0}, 0.4));
    for (int n = 0; n < 500; n++)
    {
        const Vector3d p = places.at(3.2);
        std::size_t near = 0, found = 0;
        for (const auto& q : points) near += (q.cast<double>() - p).norm() <= 0.4 ? 1 : 0;
        for (const auto& [begin, end] : grid.around(p))
            for (std::size_t i = begin; i < end; i++)
                found += (grid.points()[i].cast<double>() - p).norm() <= 0.4 ? 1 : 0;
        EXPECT_EQ(found, near);
        EXPECT_EQ(grid.hasWithin(p, 0.4), near > 0);
    }
}
