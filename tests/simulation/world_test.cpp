#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "simulation_support.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;
using ::testing::HasSubstr;

namespace
{
const char* const kPyramidObj =
    "# a pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"
    "f 1/1 2/2 3/3 4/4\nf 1 2 5\nf 2 3 5\nf -3 -2 -1\nf 4 1 5\n";
const char* const kPyramidPly =
    "ply\nformat ascii 1.0\ncomment a pyramid\nelement vertex 5\nproperty float x\n"
    "property float y\nproperty float z\nelement face 5\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n4 0 1 2 3\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

std::string binaryPyramid()
{
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty double x\n"
        "property double y\nproperty double z\nproperty uchar red\nelement face 5\n"
        "property list uchar uint vertex_indices\nend_header\n";
    const auto put = [&text](const auto& value)
    {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        text.append(bytes, sizeof value);
    };
    const double vertices[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    for (const auto& v : vertices)
    {
        for (const double x : v) put(x);
        put(static_cast<unsigned char>(200));
    }
    const std::vector<std::vector<std::uint32_t>> faces{
        {0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    for (const auto& f : faces)
    {
        put(static_cast<unsigned char>(f.size()));
        for (const std::uint32_t i : f) put(i);
    }
    return text;
}

std::string withoutEnd(const std::string& text)
{
    return text.substr(0, text.size() - 6);
}

std::string messageOf(const std::string& path)
{
    try
    {
        loadMesh(path, 0.5F);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(MeshFile, ReadsPlyAndObjAlike)
{
    const taut::test::TemporaryFolder folder;
    const std::string obj = folder / "a.obj", ply = folder / "a.ply", binary = folder / "b.ply";
    std::ofstream(obj) << kPyramidObj;
    std::ofstream(ply) << kPyramidPly;
    std::ofstream(binary, std::ios::binary) << binaryPyramid();
    for (const auto& path : {obj, ply, binary})
    {
        SCOPED_TRACE(path);
        const Mesh mesh = loadMesh(path, 0.5F);
        ASSERT_EQ(mesh.triangles.size(), 6U);
        ASSERT_EQ(mesh.reflectivity.size(), 6U);
        const RayCaster caster(mesh);
        const auto hit = caster.cast({0.5, 0.4, 3}, {0, 0, -1}, 10);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->range, 2.2, 1e-12);
    }
}

TEST(MeshFile, SaysWhatIsWrong)
{
    const taut::test::TemporaryFolder folder;
    const std::string path = folder / "bad.ply";
    const auto with = [&](const std::string& content)
    {
        std::ofstream(path, std::ios::binary) << content;
        return messageOf(path);
    };
    EXPECT_THAT(messageOf(folder / "none.ply"), HasSubstr("cannot read"));
    EXPECT_THAT(with(withoutEnd(kPyramidPly)), HasSubstr("ends early"));
    EXPECT_THAT(with(withoutEnd(binaryPyramid())), HasSubstr("ends early"));
    EXPECT_THAT(with("v 0 0 0\nf 1 2 3\n"), HasSubstr("vertex 1"));
    EXPECT_THAT(with("hello\n"), HasSubstr("no faces"));
    EXPECT_THAT(with("ply\nformat ascii 1.0\n"), HasSubstr("header has no end"));
}

TEST(RayCaster, FindsTheNearestSurfaceExactly)
{
    const RayCaster caster(smallWorld().mesh);
    const Vector3d origin(1.5, 2.25, 1.3);
    const Vector3d direction = Vector3d(-1, 0.4, 0.3).normalized();
    const auto hit = caster.cast(origin, direction, 100);
    ASSERT_TRUE(hit);
    EXPECT_NEAR((origin + hit->range * direction).x(), 0, 1e-14);
    EXPECT_NEAR(hit->normal.x(), 1, 1e-14);
    EXPECT_FALSE(caster.cast(origin, direction, 1));
    EXPECT_NEAR(caster.clearance({1, 3, 2}, 5), 1, 1e-9);
    EXPECT_NEAR(caster.clearance({6, 5, 2.3}, 5), 0.5, 1e-9);
    EXPECT_TRUE(std::isinf(caster.clearance({6, 2, 2}, 0.5)));
}

TEST(World, EveryWorldHasAWayThatKeepsClear)
{
    for (const WorldType type :
         {WorldType::Hall, WorldType::Corridor, WorldType::Stairwell, WorldType::Street,
          WorldType::Forest})
        for (const int seed : {1, 2})
        {
            SCOPED_TRACE(testing::Message() << static_cast<int>(type) << " seed " << seed);
            WorldConfig config;
            config.type = type;
            config.seed = seed;
            const World world = makeWorld(config);
            const RayCaster caster(world.mesh);
            const RoutePath path(world.route, {});
            for (double s = 0; s < path.length(); s += 1)
            {
                const Vector3d p = path.position(s) + Vector3d(0, 0, 1.4);
                EXPECT_GT(caster.clearance(p, 0.35), 0.35) << p.transpose();
            }
        }
}

TEST(Route, KeepsItsSpeedLimitsAndJoinsItsEnds)
{
    const SpeedLimits limits{3, 1, 1.5, 0.9};
    const RoutePath path(smallWorld().route, limits);
    EXPECT_NEAR(path.length(), 24, 1e-9);
    EXPECT_LT((path.position(0) - path.position(path.length())).norm(), 1e-9);
    EXPECT_NEAR(path.heading(path.length() + 1) - path.heading(1), 2 * M_PI, 1e-9);
    for (double s = 0; s < 24; s += 0.049)
    {
        const double v = path.speedLimit(s), next = path.speedLimit(s + 0.049);
        EXPECT_LE(v, 3);
        EXPECT_LE(v * v, next * next + 2 * 1 * 0.051);  // it can still brake
        const double curvature = std::abs(path.heading(s + 0.05) - path.heading(s)) / 0.05;
        EXPECT_LT(v * v * curvature, 2.0);
        EXPECT_LT(v * curvature, 1.2);
    }
}

TEST(Traffic, MoversAreHitWhereTheyAreAtThatTime)
{
    Mesh ball;
    addFrustum(ball, {0, 0, 0}, {0, 0, 1}, 0.3, 0.3, 64, 0.5F);
    std::vector<Pose> way(40);
    for (std::size_t i = 0; i < way.size(); i++)
        way[i].p = {1.0 + 0.2 * static_cast<double>(i), 0, 0};
    Scene scene{RayCaster(smallWorld().mesh), {}};
    scene.movers.emplace_back(ball, Motion(way, 0.2));  // 1 m/s along x at y = 0
    for (const double t : {0.5, 2.0, 4.0})
    {
        const Vector3d at = scene.movers[0].motion().poseAt(t).p;
        const auto hit = scene.cast(t, at + Vector3d(0, 2, 0.5), {0, -1, 0}, 20);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->range, 1.7, 0.002);
        const auto later = scene.cast(t + 1, at + Vector3d(0, 2, 0.5), {0, -1, 0}, 20);
        ASSERT_TRUE(later);
        EXPECT_NEAR(later->range, 2, 1e-9);  // the wall behind
    }
}

TEST(Traffic, KeepsItsDistanceFromTheBody)
{
    for (const WorldType type : {WorldType::Hall, WorldType::Corridor, WorldType::Street})
    {
        SCOPED_TRACE(static_cast<int>(type));
        WorldConfig config;
        config.type = type;
        const World world = makeWorld(config);
        const MotionConfig motion =
            motionPreset(type == WorldType::Street ? MotionPreset::Vehicle : MotionPreset::Walk);
        const Course course = makeCourse(motion, world.route, 40, 5);
        const Motion body = makeMotion(motion, course, 1);
        const auto movers = makeTraffic(world.traffic, course, 6, 1);
        ASSERT_EQ(movers.size(), 6U);
        for (const Mover& mover : movers)
            for (double t = 0; t < 40; t += 0.1)
                EXPECT_GT((mover.motion().poseAt(t).p - body.poseAt(t).p).head<2>().norm(), 0.5)
                    << t;
    }
}
