#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <ostream>

#include "scenes.h"
#include "taut/features/CurvatureExtractor.h"

using namespace taut;
using namespace taut::test;

namespace
{
const Box kPillar{{2.5, 1, -1.2}, {3.5, 2, 2.4}};  // floor to ceiling

Scene roomWithPillar()
{
    Scene scene;
    scene.obstacles = {kPillar};
    return scene;
}

/** Distance from a point to the nearest of the 12 edges of a box, or of the 4 upright ones. */
double distanceToEdges(const Box& box, const Vector3d& p, bool upright_only)
{
    double nearest = 1e9;
    for (int along = upright_only ? 2 : 0; along < 3; along++)
        for (int corner = 0; corner < 4; corner++)
        {
            const int u = (along + 1) % 3, v = (along + 2) % 3;
            Vector3d q = p.cwiseMax(box.min).cwiseMin(box.max);
            q[u] = corner % 2 ? box.max[u] : box.min[u];
            q[v] = corner / 2 ? box.max[v] : box.min[v];
            nearest = std::min(nearest, (p - q).norm());
        }
    return nearest;
}

std::vector<Vector3d> ofKind(const Features& features, FeatureKind kind)
{
    std::vector<Vector3d> positions;
    for (const Feature& f : features.points)
        if (f.kind == kind) positions.emplace_back(f.position.cast<double>());
    return positions;
}

/** Share of the points that are closer to an edge of the scene than that. */
double shareNearEdges(
    const std::vector<Vector3d>& points, const Scene& scene, double distance, bool upright_only)
{
    int near = 0;
    for (const Vector3d& p : points)
    {
        double nearest = distanceToEdges(scene.room, p, upright_only);
        for (const Box& box : scene.obstacles)
            nearest = std::min(nearest, distanceToEdges(box, p, upright_only));
        near += nearest < distance;
    }
    return near / static_cast<double>(points.size());
}

struct Resolution
{
    int rings, columns;
};

void PrintTo(const Resolution& r, std::ostream* out)
{
    *out << r.rings << "x" << r.columns;
}

class CurvatureAt : public ::testing::TestWithParam<Resolution>
{
};
}  // namespace

TEST_P(CurvatureAt, FindsEdgesAtCornersAndPlanesOffThem)
{
    const auto [rings, columns] = GetParam();
    SpinningLidar lidar{rings, columns};
    if (rings < 8) lidar.lowest = -5, lidar.highest = 5;
    const Scene scene = roomWithPillar();
    const Features features = CurvatureExtractor().extract(lidar.scan(scene), {});
    const auto edges = ofKind(features, FeatureKind::Edge);
    const auto planes = ofKind(features, FeatureKind::Plane);

    // Of the seven upright edges in sight, every ring sees some: others meet the floor before.
    EXPECT_GE(edges.size(), 4u * static_cast<unsigned>(rings));
    const double spacing = 9 * 2 * M_PI / columns;  // of the points on the far wall
    EXPECT_GT(shareNearEdges(edges, scene, 0.1 + spacing, false), 0.97);
    EXPECT_GE(planes.size(), 150u);
    EXPECT_LT(shareNearEdges(planes, scene, 0.04, true), 0.003);
}
INSTANTIATE_TEST_SUITE_P(
    Resolutions, CurvatureAt,
    ::testing::Values(
        Resolution{4, 300}, Resolution{4, 4096}, Resolution{16, 600}, Resolution{16, 1800},
        Resolution{64, 1024}, Resolution{128, 2048}),
    ::testing::PrintToStringParamName());

TEST(CurvatureExtractor, RejectsPointsBehindAnOcclusion)
{
    const Scene scene = roomWithPillar();
    SpinningLidar lidar{4, 1800};
    lidar.lowest = -3, lidar.highest = 3;
    CurvatureExtractor::Config config;
    config.flat_voxel = 0.01;  // every flat point
    config.max_points = 100000;
    const Features features = CurvatureExtractor(config).extract(lidar.scan(scene), {});

    // The pillar hides the walls behind it between these azimuths.
    const double from = std::atan2(1.0, 3.5), to = std::atan2(2.0, 2.5);
    const double step = 2 * M_PI / lidar.columns;
    int front = 0, rims = 0, behind = 0;
    for (const Feature& f : features.points)
    {
        const Vector3d p = f.position.cast<double>();
        const double azimuth = std::atan2(p.y(), p.x());
        if (p.head<2>().norm() < 4.2)
        {
            front += azimuth > from && azimuth < to;
            rims += f.kind == FeatureKind::Edge &&
                    std::min(std::abs(azimuth - from), std::abs(azimuth - to)) < 2 * step;
        }
        else
            behind += azimuth > from - 5 * step && azimuth < to + 5 * step;
    }
    EXPECT_EQ(behind, 0);
    EXPECT_GT(front, 100);
    EXPECT_EQ(rims, 2 * lidar.rings) << "the rims of the pillar are edges";
}

TEST(CurvatureExtractor, RejectsPointsBesideAGap)
{
    Scan scan = SpinningLidar{4, 1800, -3, 3}.scan(Scene{});
    const auto azimuth = [](const auto& p) { return std::atan2(p.y(), p.x()); };
    for (auto& p : scan.points)
        if (std::abs(azimuth(p.position)) < 0.1) p.position.setConstant(NAN);
    CurvatureExtractor::Config config;
    config.flat_voxel = 0.01;
    config.max_points = 100000;
    const Features features = CurvatureExtractor(config).extract(scan, {});
    EXPECT_GT(features.points.size(), 3000u);
    for (const Feature& f : features.points) EXPECT_GT(std::abs(azimuth(f.position)), 0.115);
}

TEST(CurvatureExtractor, RejectsGrazingSurfaces)
{
    // A long wall close by: its far parts are almost parallel to the beams.
    Scene scene;
    scene.room = {{-60, -0.8, -1.2}, {60, 6, 2.4}};
    SpinningLidar lidar{4, 3600, -0.6, 0.6};
    const Features features = CurvatureExtractor().extract(lidar.scan(scene), {});
    int on_wall = 0;
    for (const Feature& f : features.points)
        if (f.position.y() < -0.5)
        {
            on_wall++;
            EXPECT_LT(std::abs(f.position.x()), 0.8 * std::tan(82 * M_PI / 180));
        }
    EXPECT_GT(on_wall, 20);
}

TEST(CurvatureExtractor, KeepsADistanceBetweenTheFeaturesOfARing)
{
    CurvatureExtractor::Config config;
    config.flat_voxel = 0;
    config.feature_distance = 0.5;
    config.min_points = 0;
    const Features features =
        CurvatureExtractor(config).extract(SpinningLidar{1, 1800, 0, 0}.scan(Scene{}), {});
    ASSERT_GT(features.points.size(), 30u);
    for (std::size_t i = 1; i < features.points.size(); i++)
        EXPECT_GE((features.points[i].position - features.points[i - 1].position).norm(), 0.5f);
}

TEST(CurvatureExtractor, TakesAllSectorsOfARing)
{
    CurvatureExtractor::Config config;
    config.flat_voxel = 0;
    config.sectors = 6;
    config.edges_per_sector = 0;
    config.planes_per_sector = 3;
    config.min_points = 0;
    const Features features =
        CurvatureExtractor(config).extract(SpinningLidar{4, 1800, -3, 3}.scan(Scene{}), {});
    EXPECT_EQ(features.points.size(), 4u * 6 * 3);
}

TEST(CurvatureExtractor, OrdersPointsOfOneTimeByTheSenseOfRotation)
{
    // Twelve columns to a time stamp, as in packets; turning one way or the other.
    for (const bool mirrored : {false, true})
    {
        Scan scan = SpinningLidar{8, 900, -5, 5}.scan(roomWithPillar());
        const auto exact = CurvatureExtractor().extract(scan, {}).points.size();
        for (LidarPoint& p : scan.points)
        {
            p.offset -= p.offset % (12 * 100'000'000 / 900);
            if (mirrored) p.position.y() *= -1;
        }
        EXPECT_EQ(CurvatureExtractor().extract(scan, {}).points.size(), exact);
    }
}

TEST(CurvatureExtractor, WorksWhereShortAndLongStepsAlternate)
{
    const SpinningLidar lidar{8, 7200, -5, 5};
    const Scan dense = lidar.scan(roomWithPillar());
    Scan scan = dense;
    scan.points.clear();
    for (int column = 0; column < lidar.columns; column++)
        for (int ring = 0; ring < lidar.rings && column % 8 < 2; ring++)
            scan.points.push_back(
                dense.points[static_cast<std::size_t>(column * lidar.rings + ring)]);
    const Features features = CurvatureExtractor().extract(scan, {});
    EXPECT_GE(ofKind(features, FeatureKind::Edge).size(), 4u * 8);
    EXPECT_GE(ofKind(features, FeatureKind::Plane).size(), 300u);
}

TEST(CurvatureExtractor, WorksOnScansWhosePointsHaveOneTime)
{
    Scan scan = SpinningLidar{}.scan(roomWithPillar());
    const auto exact = CurvatureExtractor().extract(scan, {}).points.size();
    for (LidarPoint& p : scan.points) p.offset = 0;
    EXPECT_EQ(CurvatureExtractor().extract(scan, {}).points.size(), exact);
}

TEST(CurvatureExtractor, NamesTheAlternativeForScansWithoutRings)
{
    Scan scan = SpinningLidar{}.scan(Scene{});
    scan.rings = 0;
    try
    {
        CurvatureExtractor().extract(scan, {});
        FAIL() << "no error";
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_THAT(e.what(), ::testing::HasSubstr("VoxelThinning"));
    }
}

TEST(CurvatureExtractor, RejectsARingThatTheScanDoesNotHave)
{
    Scan scan = SpinningLidar{}.scan(Scene{});
    scan.points[100].ring = 16;
    EXPECT_THROW(CurvatureExtractor().extract(scan, {}), std::runtime_error);
}

TEST(CurvatureExtractor, WarnsWhenItHasToThinLess)
{
    std::vector<Warning> warnings;
    CurvatureExtractor::Config config;
    config.min_points = 2000;
    const Features features = CurvatureExtractor(config).extract(
        SpinningLidar{8, 600}.scan(roomWithPillar()),
        [&](const Warning& w) { warnings.push_back(w); });
    EXPECT_GE(features.points.size(), 2000u);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].kind, "few_features");
}

TEST(CurvatureExtractor, UsesTheWholeScanWhereNothingIsFlatOrAnEdge)
{
    Random random(5);
    Scan scan = SpinningLidar{}.scan(Scene{});
    for (LidarPoint& p : scan.points)
        p.position *= static_cast<float>(random.uniform(0.3, 1));  // leaves, say
    std::vector<Warning> warnings;
    const Features features =
        CurvatureExtractor().extract(scan, [&](const Warning& w) { warnings.push_back(w); });
    EXPECT_GE(features.points.size(), 300u);
    EXPECT_FALSE(ofKind(features, FeatureKind::Any).empty());
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings[0].kind, "few_features");
}
