#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

WorldConfig worldOf(WorldType type, int seed = 1)
{
    WorldConfig config;
    config.type = type;
    config.seed = seed;
    return config;
}

/** Ranges all around a place, level and a little up and down [m]; -1 where there is nothing. */
std::vector<double> rangesAt(const RayCaster& caster, const Vector3d& place)
{
    std::vector<double> ranges;
    for (const double rise : {-0.15, 0.0, 0.15})
        for (int i = 0; i < 360; i++)
        {
            const double angle = 2 * M_PI * i / 360;
            const Vector3d direction(std::cos(angle), std::sin(angle), rise);
            const auto hit = caster.cast(place, direction.normalized(), 100);
            ranges.push_back(hit ? hit->range : -1);
        }
    return ranges;
}

/** Part of the ranges at a place that are others at another. */
double shareOfOthers(const RayCaster& caster, const Vector3d& a, const Vector3d& b)
{
    const std::vector<double> here = rangesAt(caster, a), there = rangesAt(caster, b);
    double others = 0;
    for (std::size_t i = 0; i < here.size(); i++) others += std::abs(here[i] - there[i]) > 1e-6;
    return others / static_cast<double>(here.size());
}

/** Length over which a route runs beside an earlier part of itself [m]: in the same direction (1)
 * or the opposite one (-1). */
double repeatedLength(const RoutePath& path, double direction)
{
    constexpr double step = 2, near = 5, since = 50;
    const auto heading = [&path](double s)
    { return Vector3d(std::cos(path.heading(s)), std::sin(path.heading(s)), 0); };
    double length = 0;
    for (double s = 0; s < path.length(); s += step)
        for (double earlier = 0; earlier < s - since; earlier += step)
            if ((path.position(s) - path.position(earlier)).norm() < near &&
                direction * heading(s).dot(heading(earlier)) > 0.9)
            {
                length += step;
                break;
            }
    return length;
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
    // Elements that take no bytes went on for ever, or until the memory was full.
    const std::string begin = "ply\nformat ascii 1.0\nelement ";
    EXPECT_THAT(
        with(begin + "vertex 18446744073709551615\nend_header\n"), HasSubstr("no properties"));
    EXPECT_THAT(with(begin + "vertex many\nend_header\n"), HasSubstr("without a name or a number"));
    // The cast overflowed.
    EXPECT_THAT(
        with(
            begin + "face 1\nproperty list uchar double vertex_indices\nend_header\n3 0 1e300 1\n"),
        HasSubstr("does not exist"));
}

TEST(MeshFile, MayHaveEmptyLinesInItsHeader)
{
    const taut::test::TemporaryFolder folder;
    std::string text = kPyramidPly;
    text.insert(text.find("property"), "\n \n");  // the element was taken to be there twice
    std::ofstream(folder / "a.ply") << text;
    EXPECT_EQ(loadMesh(folder / "a.ply", 0.5F).vertices.size(), 5U);
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

namespace
{
/** Indices of the triangles of a that have other corners in b. */
std::vector<std::size_t> movedTriangles(const Mesh& a, const Mesh& b)
{
    std::vector<std::size_t> moved;
    for (std::size_t i = 0; i < a.triangles.size(); i++)
        for (int k = 0; k < 3; k++)
            if (a.vertices[a.triangles[i][k]] != b.vertices[b.triangles[i][k]])
            {
                moved.push_back(i);
                break;
            }
    return moved;
}
}  // namespace

TEST(World, EveryWorldHasAWayThatKeepsClear)
{
    for (const WorldType type :
         {WorldType::Hall, WorldType::Corridor, WorldType::Stairwell, WorldType::Street,
          WorldType::Forest, WorldType::Storeys, WorldType::Halls, WorldType::Blocks,
          WorldType::Tunnel, WorldType::Field})
        for (const int seed : {1, 2})
        {
            SCOPED_TRACE(testing::Message() << static_cast<int>(type) << " seed " << seed);
            WorldConfig config;
            config.type = type;
            config.seed = seed;
            config.moved = seed - 1;
            config.distinct = 3;
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

TEST(World, TheSameSeedGivesTheSameBits)
{
    for (const WorldType type :
         {WorldType::Storeys, WorldType::Halls, WorldType::Blocks, WorldType::Tunnel,
          WorldType::Field})
    {
        SCOPED_TRACE(static_cast<int>(type));
        const World a = makeWorld(worldOf(type)), b = makeWorld(worldOf(type));
        const World other = makeWorld(worldOf(type, 2));
        EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
        EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
        EXPECT_EQ(a.mesh.reflectivity, b.mesh.reflectivity);
        EXPECT_EQ(a.route.corners, b.route.corners);
        EXPECT_NE(a.mesh.vertices, other.mesh.vertices);
        EXPECT_LT(a.mesh.triangles.size(), 600000U);
    }
}

TEST(World, TheStoreysAreAlikeAndEachIsGoneRoundTwice)
{
    const World world = makeWorld(worldOf(WorldType::Storeys));
    const RayCaster caster(world.mesh);
    for (const auto& [x, y] : {std::pair{2.0, 0.1}, {25.0, -0.3}, {30.2, 11.0}, {8.0, 20.0}})
        EXPECT_EQ(shareOfOthers(caster, {x, y, 1.4}, {x, y, 1.4 + 3.2}), 0) << x << " " << y;

    const RoutePath path(world.route, {});
    double below = 0, above = 0, stairs = 0;
    for (double s = 0; s < path.length(); s += 0.1)
    {
        const double z = path.position(s).z();
        (z < 0.01 ? below : z > 3.19 ? above : stairs) += 0.1;
    }
    EXPECT_NEAR(below, 200, 10);
    EXPECT_NEAR(above, 200, 10);
    EXPECT_GT(stairs, 2 * 6.4);
}

TEST(World, TheCorridorsOfTheStoreysAreAlmostPlain)
{
    const RayCaster caster(makeWorld(worldOf(WorldType::Storeys)).mesh);
    for (double x = 1.5; x < 28.5; x += 0.1)
    {
        if (std::abs(x - 12) < 0.75) continue;  // the doorway to the stairs
        for (const double y : {-1.0, 1.0})
        {
            const auto hit = caster.cast({x, 0, 1.4}, {0, y, 0}, 100);
            ASSERT_TRUE(hit);
            EXPECT_NEAR(hit->range, 1.235, 0.036) << x;
        }
    }
}

TEST(World, TheHallsAreAlikeUnlessObjectsTellThemApart)
{
    WorldConfig config = worldOf(WorldType::Halls);
    const auto leastDifference = [&config]
    {
        const RayCaster caster(makeWorld(config).mesh);
        const Vector3d place(6, 7.1, 1.1), pitch(12.3, 0, 0);
        double least = 1;
        for (const int hall : {1, 2, 3})
            least = std::min(least, shareOfOthers(caster, place, place + hall * pitch));
        return least;
    };
    EXPECT_LT(leastDifference(), 0.005) << "only what is seen through the doorways";
    config.distinct = 2;
    EXPECT_GT(leastDifference(), 0.02);
    config.distinct = 6;
    EXPECT_GT(leastDifference(), 0.08);
}

TEST(World, TheBlocksAreDrivenInTheSameAndInTheOppositeDirection)
{
    const RoutePath path(makeWorld(worldOf(WorldType::Blocks)).route, {});
    EXPECT_GT(path.length(), 2000);
    EXPECT_GT(repeatedLength(path, 1), 150);
    EXPECT_GT(repeatedLength(path, -1), 80);
    double lowest = 100, highest = -100;
    for (double s = 0; s < path.length(); s += 1)
    {
        lowest = std::min(lowest, path.position(s).z());
        highest = std::max(highest, path.position(s).z());
        EXPECT_LT(std::abs(path.position(s + 1).z() - path.position(s).z()), 0.06);
    }
    EXPECT_GT(highest - lowest, 3);
}

TEST(World, TheTunnelIsPlainButForItsRefuges)
{
    WorldConfig config = worldOf(WorldType::Tunnel);
    const auto sideways = [&config](double x) {
        return RayCaster(makeWorld(config).mesh).cast({x, 0, 1}, {0, 1, 0}, 100)->range;
    };
    for (const double x : {1.0, 25.0, 99.3, 175.0, 249.0}) EXPECT_NEAR(sideways(x), 2.5, 1e-9);
    config.refuges = true;
    for (const double x : {25.0, 75.0, 225.0}) EXPECT_NEAR(sideways(x), 2.9, 1e-9);
    for (const double x : {1.0, 50.0, 100.0}) EXPECT_NEAR(sideways(x), 2.5, 1e-9);

    const RayCaster caster(makeWorld(config).mesh);
    for (const double x : {-20.0, 270.0})  // there is something to see at the ends
    {
        const std::vector<double> ranges = rangesAt(caster, {x, 8, 2});
        EXPECT_GT(std::count_if(ranges.begin(), ranges.end(), [](double r) { return r > 0; }), 300);
    }
}

TEST(World, TheFieldIsEmptyUpToItsRim)
{
    const World world = makeWorld(worldOf(WorldType::Field));
    const RayCaster caster(world.mesh);
    const RoutePath path(world.route, {});
    for (double s = 0; s < path.length(); s += 5)
    {
        const Vector3d p = path.position(s) + Vector3d(0, 0, 1.4);
        int seen = 0;
        for (int i = 0; i < 720; i++)
        {
            const double angle = 2 * M_PI * i / 720;
            const auto hit = caster.cast(p, {std::cos(angle), std::sin(angle), 0}, 100);
            if (!hit) continue;
            EXPECT_GT(hit->range, 15);
            seen++;
        }
        EXPECT_GT(seen, 20);
        EXPECT_LT(seen, 250);
    }
    EXPECT_GT(repeatedLength(path, 1), 50);
    EXPECT_GT(path.length(), 2 * 150);
}

TEST(World, AShareOfThingsStandsElsewhereInAnotherSession)
{
    for (const WorldType type :
         {WorldType::Hall, WorldType::Street, WorldType::Halls, WorldType::Blocks})
    {
        SCOPED_TRACE(static_cast<int>(type));
        const auto meshOf = [type](double moved, int moved_seed)
        {
            WorldConfig config = worldOf(type);
            config.moved = moved;
            config.moved_seed = moved_seed;
            return makeWorld(config).mesh;
        };
        const Mesh before = meshOf(0, 1), later = meshOf(0.4, 1), other = meshOf(0.4, 2);
        EXPECT_EQ(before.vertices, meshOf(0, 2).vertices);
        EXPECT_EQ(later.vertices, meshOf(0.4, 1).vertices);
        EXPECT_NE(later.vertices, other.vertices);
        // The same things, and all that has not moved is the same to the bit.
        EXPECT_EQ(before.triangles, later.triangles);
        EXPECT_EQ(before.reflectivity, later.reflectivity);
        const auto all = movedTriangles(before, meshOf(1, 1)), some = movedTriangles(before, later);
        EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
        EXPECT_LT(all.size(), before.triangles.size() * 2 / 3);
        const double share = static_cast<double>(some.size()) / static_cast<double>(all.size());
        EXPECT_NEAR(share, 0.4, type == WorldType::Blocks ? 0.02 : 0.12);
        for (const std::size_t i : some)  // elsewhere, and not merely a little aside
        {
            const Vector3d from = before.vertices[before.triangles[i][0]];
            EXPECT_GT((later.vertices[later.triangles[i][0]] - from).norm(), 0.3);
        }
    }
}

TEST(World, NothingReturnsFromWindowsOfGlass)
{
    // The share of rays through the windows of a wall that find nothing.
    const auto lost = [](WorldType type, double glass)
    {
        WorldConfig config = worldOf(type);
        config.glass = glass;
        const RayCaster caster(makeWorld(config).mesh);
        const bool halls = type == WorldType::Halls;
        double rays = 0, nothing = 0;
        for (double s = 1; s < (halls ? 48 : 19); s += 0.05)
        {
            const Vector3d origin = halls ? Vector3d(s, 5, 2.4) : Vector3d(30, s, 1.5);
            const Vector3d direction = halls ? Vector3d::UnitY() : Vector3d::UnitX();
            if (halls && std::fmod(s, 12.3) > 12) continue;  // between two halls
            rays++;
            nothing += !caster.cast(origin, direction, 200);
        }
        return nothing / rays;
    };
    for (const WorldType type : {WorldType::Storeys, WorldType::Halls})
    {
        EXPECT_EQ(lost(type, 0), 0);
        const double all = lost(type, 1);
        EXPECT_GT(all, 0.4);
        EXPECT_NEAR(lost(type, 0.5), all / 2, 0.1);
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
