#include "taut/render/ViewCamera.h"

#include <gtest/gtest.h>

#include "structures.h"

using namespace taut;

namespace
{
constexpr PixelSize kSize{800, 500};

/** All points of the scene lie within the picture, with a margin of some pixels. */
void expectAllInSight(const ViewCamera& camera, const RenderScene& scene, double margin)
{
    for (const auto& point : scene.points)
    {
        const Vector3d pixel = camera.project(point.cast<double>());
        ASSERT_GE(pixel.x(), margin);
        ASSERT_LE(pixel.x(), camera.size.width - margin);
        ASSERT_GE(pixel.y(), margin);
        ASSERT_LE(pixel.y(), camera.size.height - margin);
        ASSERT_TRUE(camera.sees(point.cast<double>()));
    }
}
}  // namespace

TEST(TopCamera, FitsAWideMapWithXToTheRight)
{
    const PointCloud corners{{0, 0, 0}, {90, 20, 1}};
    const ViewCamera camera = makeCamera(View::Top, corners, {}, {1000, 600});
    EXPECT_TRUE(camera.orthographic);
    EXPECT_NEAR(camera.scale, 10, 1e-9);  // 90 m on 1000 pixels less 5 % on each side
    const Vector3d origin = camera.project({0, 0, 0}), far = camera.project({90, 20, 0});
    EXPECT_NEAR(origin.x(), 50, 1e-6);
    EXPECT_NEAR(origin.y(), 400, 1e-6);
    EXPECT_NEAR(far.x(), 950, 1e-6);
    EXPECT_NEAR(far.y(), 200, 1e-6);
}

TEST(TopCamera, TurnsATallMapByAQuarterSoThatXPointsUp)
{
    const PointCloud corners{{0, 0, 0}, {20, 90, 1}};
    const ViewCamera camera = makeCamera(View::Top, corners, {}, {1000, 600});
    EXPECT_NEAR(camera.scale, 10, 1e-9);
    const Vector3d origin = camera.project({0, 0, 0}), x = camera.project({1, 0, 0});
    EXPECT_NEAR((x - origin).x(), 0, 1e-9);
    EXPECT_NEAR((x - origin).y(), -10, 1e-9);
}

TEST(TopCamera, DoesNotMagnifyALonePointEndlessly)
{
    const ViewCamera camera = makeCamera(View::Top, {{5, 5, 5}}, {}, kSize);
    EXPECT_LT(camera.scale, 500);
    EXPECT_TRUE(camera.sees({5, 5, 5}));
}

TEST(ObliqueCamera, HasAllOfTheMapInSightAndFillsThePicture)
{
    for (const RenderScene& scene : {test::hall(), test::street()})
        for (const PixelSize size : {kSize, PixelSize{400, 700}})
        {
            const ViewCamera camera =
                makeCamera(View::Oblique, scene.points, scene.trajectory, size);
            expectAllInSight(camera, scene, 0.04 * std::min(size.width, size.height));
            Span u{1e9, -1e9}, v{1e9, -1e9};
            for (const auto& point : scene.points)
            {
                const Vector3d pixel = camera.project(point.cast<double>());
                u = {std::min(u.low, pixel.x()), std::max(u.high, pixel.x())};
                v = {std::min(v.low, pixel.y()), std::max(v.high, pixel.y())};
            }
            EXPECT_GT(std::max(u.size() / size.width, v.size() / size.height), 0.85);
        }
}

TEST(ObliqueCamera, LooksDownWithTheHorizonLevel)
{
    const RenderScene scene = test::hall();
    const ViewCamera camera = makeCamera(View::Oblique, scene.points, scene.trajectory, kSize);
    EXPECT_FALSE(camera.orthographic);
    EXPECT_NEAR(camera.T_world_camera.R(2, 0), 0, 1e-12);
    EXPECT_LT(camera.T_world_camera.R(2, 2), -0.5);
    EXPECT_NEAR(camera.T_world_camera.R.determinant(), 1, 1e-12);
}

TEST(FollowCamera, IsBehindAndAboveABodyThatMoves)
{
    const RenderScene scene = test::street();
    const ViewCamera camera = makeCamera(View::Follow, scene.points, scene.trajectory, kSize);
    const Vector3d eye = camera.T_world_camera.p;
    EXPECT_LT(eye.x(), 195);
    EXPECT_NEAR(eye.y(), 0, 1e-9);
    EXPECT_GT(eye.z(), 2);
    const Vector3d body = camera.project({200, 0, 0}), ahead = camera.project({230, 0, 0});
    EXPECT_NEAR(body.x(), kSize.width / 2.0, 1e-6);
    EXPECT_GT(body.y(), 0.3 * kSize.height);
    EXPECT_LT(body.y(), 0.8 * kSize.height);
    EXPECT_LT(ahead.y(), body.y());
    EXPECT_TRUE(camera.sees({200, 0, 0}));
}

TEST(FollowCamera, LooksAlongTheBodyWhereItDoesNotMove)
{
    Pose pose;
    pose.R = expSO3({0, 0, M_PI / 2});
    const ViewCamera camera = makeCamera(View::Follow, {}, std::vector<Pose>(10, pose), kSize);
    EXPECT_NEAR(camera.T_world_camera.p.x(), 0, 1e-9);
    EXPECT_LT(camera.T_world_camera.p.y(), -1);
    // straight up, the x axis gives no direction
    pose.R = expSO3({0, -M_PI / 2, 0});
    EXPECT_TRUE(makeCamera(View::Follow, {}, {pose}, kSize).T_world_camera.R.allFinite());
}
