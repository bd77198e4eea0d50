/** What real sensors and places do wrong, against closed forms. */
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;
using ::testing::HasSubstr;

namespace
{
LidarConfig plain(LidarType type = LidarType::Vlp16)
{
    LidarConfig config = lidarPreset(type);
    config.range_noise = config.range_step = config.dropout = config.detection_range = 0;
    config.divergence = 0;
    return config;
}

/** A wall across x, `distance` away, seen by a sensor in the origin. */
Scene wallAt(double distance, Material material = Material::Solid)
{
    constexpr double half = 300;
    Mesh mesh;
    addQuad(
        mesh, {distance, -half, -half}, {distance, half, -half}, {distance, half, half},
        {distance, -half, half}, 0.5F);
    mesh.mark(0, material);
    return {RayCaster(mesh), {}};
}

const Motion& still()
{
    static const Motion motion(std::vector<Pose>(20), 1);
    return motion;
}

/** At rest in the small room. */
const Motion& inRoom()
{
    static const Motion motion(
        std::vector<Pose>(20, Pose{Matrix3d::Identity(), Vector3d(3, 2.5, 1.4)}), 1);
    return motion;
}

SimulatedScan sweepOf(
    const LidarConfig& config, const Scene& scene, const Motion& motion, int k = 3,
    const WeatherConfig& weather = {})
{
    Executor executor(2);
    return Lidar(config, 5, weather).sweep(k, motion, scene, executor);
}

float distanceOf(const LidarPoint& p)
{
    return p.position.norm();
}

/** Points by ring and time: the shots that they came from. */
std::map<std::pair<int, int>, LidarPoint> byShot(const Scan& scan)
{
    std::map<std::pair<int, int>, LidarPoint> points;
    for (const LidarPoint& p : scan.points) points[{p.ring, p.offset}] = p;
    return points;
}

std::string refusal(const std::vector<std::string>& settings)
{
    try
    {
        ConfigSection section =
            loadScenarioFile(std::string(TAUT_SCENARIOS) + "/hall_violent.yaml", settings);
        readScenario(section);
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(Reality, DarkSurfacesAreMeasuredLong)
{
    const Scene scene = smallScene();
    LidarConfig config = plain();
    const SimulatedScan clean = sweepOf(config, scene, inRoom());
    config.intensity_error = 0.2;
    const SimulatedScan biased = sweepOf(config, scene, inRoom());
    ASSERT_EQ(clean.scan.points.size(), biased.scan.points.size());
    for (std::size_t i = 0; i < clean.scan.points.size(); i++)
    {
        const LidarPoint &a = clean.scan.points[i], &b = biased.scan.points[i];
        const double expected = 0.2 * (1 - a.intensity / 255);
        ASSERT_NEAR(distanceOf(b) - distanceOf(a), expected, 0.2 * 0.51 / 255 + 2e-6);
    }
}

TEST(Reality, SlantingSurfacesAreMeasuredLongByAPartOfTheFootprint)
{
    const Scene scene = wallAt(5);
    LidarConfig config = plain();
    config.T_imu_lidar = {};
    config.divergence = 3e-3;
    const SimulatedScan clean = sweepOf(config, scene, still());
    config.incidence_error = -0.8;
    const SimulatedScan biased = sweepOf(config, scene, still());
    const auto before = byShot(clean.scan);
    double largest = 0;
    for (const LidarPoint& p : biased.scan.points)
    {
        const LidarPoint& a = before.at({p.ring, p.offset});
        const double range = distanceOf(a), cosine = a.position.x() / range;
        const double depth = range * std::sqrt(1 - cosine * cosine) / cosine * 3e-3;
        const double error = distanceOf(p) - range;
        ASSERT_NEAR(error, -0.8 * std::min(depth, 0.5) / 2, 2e-4);
        largest = std::max(largest, -error);
    }
    EXPECT_NEAR(largest, 0.2, 1e-3) << "no deeper than the pulse is long";
}

TEST(Reality, PacketsAreLostInBursts)
{
    PacketLoss loss;
    loss.share = 0.08;
    loss.burst = 5;
    Random random(3);
    constexpr std::size_t count = 400000;
    const std::vector<bool> lost = lostPackets(loss, count, random);
    double sum = 0, bursts = 0;
    for (std::size_t i = 0; i < count; i++)
    {
        sum += lost[i];
        bursts += lost[i] && (i == 0 || !lost[i - 1]);
    }
    EXPECT_NEAR(sum / count, 0.08, 0.004);
    EXPECT_NEAR(sum / bursts, 5, 0.15);
}

TEST(Reality, ALostPacketLeavesASectorEmptyAndTheOthersAsTheyWere)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    LidarConfig config = plain();
    config.range_noise = 0.02;
    std::map<int, std::pair<int, int>> packets;  // points there were, and are
    double there = 0, all = 0;
    for (int k = 10; k < 40; k++)
    {
        LidarConfig lossy = config;
        lossy.packet_loss.share = 0.2;
        lossy.packet_loss.burst = 3;
        const SimulatedScan whole = sweepOf(config, scene, motion, k);
        const SimulatedScan rest = sweepOf(lossy, scene, motion, k);
        const auto before = byShot(whole.scan);
        packets.clear();
        constexpr int packet = 24 * 55296;
        for (const LidarPoint& p : whole.scan.points) packets[p.offset / packet].first++;
        const Pose T_end = motion.poseAt(toSeconds(rest.scan.end));
        Time last = 0;
        for (std::size_t i = 0; i < rest.scan.points.size(); i++)
        {
            const LidarPoint& p = rest.scan.points[i];
            packets[p.offset / packet].second++;
            ASSERT_EQ(before.at({p.ring, p.offset}).position, p.position);
            last = std::max(last, rest.scan.timeOf(p));
            // Range noise stays in the truth.
            ASSERT_LT((T_end * rest.truth[i].cast<double>() - rest.surface[i]).norm(), 0.15);
        }
        ASSERT_EQ(last, rest.scan.end) << "the sweep ends where its last point is";
        for (const auto& [index, counts] : packets)
            ASSERT_TRUE(counts.second == 0 || counts.second == counts.first) << index;
        there += static_cast<double>(rest.scan.points.size());
        all += static_cast<double>(whole.scan.points.size());
    }
    EXPECT_NEAR(1 - there / all, 0.2, 0.04);
}

TEST(Reality, TheRecordingTellsAnotherMountThanTheWorldHas)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    LidarConfig config = plain();
    config.T_imu_lidar = {expSO3(Vector3d(0.1, -0.2, 0.3)), Vector3d(0.1, 0.05, -0.15)};
    config.mount_error = {expSO3(Vector3d(0.02, 0.03, -0.01)), Vector3d(0.03, -0.02, 0.01)};
    const SimulatedScan s = sweepOf(config, scene, motion, 30);
    EXPECT_EQ(s.scan.T_imu_lidar.R, config.T_imu_lidar.R);
    EXPECT_EQ(s.scan.T_imu_lidar.p, config.T_imu_lidar.p);
    const Pose T_imu_true = config.T_imu_lidar * config.mount_error;
    const Pose T_end = motion.poseAt(toSeconds(s.scan.end));
    for (std::size_t i = 0; i < s.scan.points.size(); i += 7)
    {
        const LidarPoint& p = s.scan.points[i];
        const Pose T = motion.poseAt(toSeconds(s.scan.timeOf(p)));
        ASSERT_LT((T * (T_imu_true * p.position.cast<double>()) - s.surface[i]).norm(), 5e-6);
        ASSERT_LT((T_end * s.truth[i].cast<double>() - s.surface[i]).norm(), 1e-5);
    }
}

TEST(Reality, ASoftMountVibratesWithItsFrequencyAndAmplitude)
{
    LidarConfig config = plain();
    config.soft_mount = {37, 0.004, 0.002};
    const Mount mount(config, 8);
    // The part of each coordinate that has the frequency, over whole periods; the rest is nothing.
    constexpr int count = 20000;
    Eigen::Matrix<double, 6, 1> sine = Eigen::Matrix<double, 6, 1>::Zero(), cosine = sine,
                                square = sine;
    for (int i = 0; i < count; i++)
    {
        const double t = 10.0 * i / count;
        const Pose T = config.T_imu_lidar.inverse() * mount.at(t);
        Eigen::Matrix<double, 6, 1> v;
        v << logSO3(T.R), T.p;
        sine += 2.0 / count * std::sin(2 * M_PI * 37 * t) * v;
        cosine += 2.0 / count * std::cos(2 * M_PI * 37 * t) * v;
        square += 2.0 / count * v.cwiseProduct(v);
    }
    for (int i = 0; i < 6; i++)
    {
        const double amplitude = i < 3 ? 0.004 : 0.002;
        EXPECT_NEAR(std::hypot(sine[i], cosine[i]), amplitude, 1e-3 * amplitude) << i;
        EXPECT_NEAR(std::sqrt(square[i]), amplitude, 1e-3 * amplitude) << i;
    }

    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    const SimulatedScan s = sweepOf(config, scene, motion, 30);
    const std::vector<Eigen::Vector3f> told = undistorted(s.scan, motion);
    const Pose T_end = motion.poseAt(toSeconds(s.scan.end));
    float largest = 0;
    for (std::size_t i = 0; i < s.truth.size(); i += 7)
    {
        ASSERT_LT((T_end * s.truth[i].cast<double>() - s.surface[i]).norm(), 1e-5);
        largest = std::max(largest, (told[i] - s.truth[i]).norm());
    }
    EXPECT_GT(largest, 0.003F) << "the points themselves are off";
}

TEST(Reality, TheOwnBodyStaysWhereItIsInTheViewOfTheLidar)
{
    const Scene scene = wallAt(60);
    const Motion moving = motionOf(MotionPreset::Violent, 6, 1);
    const auto fixedPoints = [&](LidarType type, OwnBody body)
    {
        LidarConfig config = plain(type);
        config.own_body = body;
        const auto a = byShot(sweepOf(config, scene, still(), 20).scan);
        const auto b = byShot(sweepOf(config, scene, moving, 20).scan);
        int fixed = 0;
        for (const auto& [shot, p] : a)
        {
            const auto other = b.find(shot);
            fixed += other != b.end() && (other->second.position - p.position).norm() < 1e-5F;
            if (p.position.norm() < 3)
            {
                EXPECT_NE(other, b.end());
            }
        }
        return fixed;
    };
    EXPECT_EQ(fixedPoints(LidarType::Vlp16, OwnBody::None), 0);
    EXPECT_GT(fixedPoints(LidarType::Vlp16, OwnBody::Person), 500);
    EXPECT_GT(fixedPoints(LidarType::Vlp16, OwnBody::Car), 300);
    EXPECT_GT(fixedPoints(LidarType::Hdl32, OwnBody::Car), 2000);
    EXPECT_GT(fixedPoints(LidarType::Os1_64, OwnBody::Multicopter), 300);
}

TEST(Reality, DropsSendBackWhatTheLawSays)
{
    const Scene scene = smallScene();
    LidarConfig config = plain();
    const auto clean = byShot(sweepOf(config, scene, inRoom()).scan);
    WeatherConfig weather;
    weather.near_returns = 0.3;
    weather.near_reach = 2;
    const auto wet = byShot(sweepOf(config, scene, inRoom(), 3, weather).scan);
    EXPECT_EQ(wet.size(), clean.size());
    double expected = 0, count = 0, sum = 0, expected_sum = 0;
    for (const auto& [shot, p] : clean)
    {
        const double range = distanceOf(p), a = config.min_range / 2, b = range / 2;
        expected += 0.3 * (std::exp(-a) - std::exp(-b));
        expected_sum += 0.3 * 2 * ((a + 1) * std::exp(-a) - (b + 1) * std::exp(-b));
        const LidarPoint& q = wet.at(shot);
        if (q.position == p.position) continue;
        ASSERT_LT(distanceOf(q), range);
        ASSERT_GE(distanceOf(q), config.min_range - 1e-6);
        ASSERT_LT(q.intensity, 20);
        count++;
        sum += distanceOf(q);
    }
    EXPECT_NEAR(count, expected, 4 * std::sqrt(expected));
    EXPECT_NEAR(sum / count, expected_sum / expected, 0.05);
}

TEST(Reality, RainAndDustTakeTheLightOfFarShots)
{
    WeatherConfig weather;
    weather.rain = 10;
    EXPECT_NEAR(extinction(weather), 0.01 * std::pow(10, 0.6), 1e-12);
    weather.dust = 0.03;
    EXPECT_NEAR(transmitted(weather, 20), std::exp(-2 * 20 * (0.03 + 0.0398107)), 1e-6);

    const Scene scene = wallAt(20);
    LidarConfig config = plain();
    config.T_imu_lidar = {};
    const auto all = byShot(sweepOf(config, scene, still()).scan);
    config.detection_range = 120;
    const SimulatedScan some = sweepOf(config, scene, still(), 3, weather);
    double expected = 0;
    for (const auto& [shot, p] : all)
    {
        const double range = distanceOf(p), cosine = p.position.x() / range;
        const double signal =
            0.5 * cosine / (range * range) * 14400 * std::exp(-2 * range * extinction(weather));
        expected += 1 / (1 + std::pow(std::max(signal, 1e-3), -4));
    }
    const auto seen = static_cast<double>(some.scan.points.size());
    EXPECT_LT(expected, 0.5 * static_cast<double>(all.size()));
    EXPECT_NEAR(seen, expected, 4 * std::sqrt(expected));
    for (const LidarPoint& p : some.scan.points)
    {
        const double range = distanceOf(p);
        ASSERT_NEAR(
            p.intensity, 255 * 0.5 * p.position.x() / range * transmitted(weather, range), 0.51);
    }
}

TEST(Reality, RoughSurfacesHaveHeightsThatStay)
{
    Scene scene = wallAt(8);
    scene.texture.seed = 4;
    scene.texture.roughness = 0.03;
    scene.texture.roughness_length = 0.05;
    double sum = 0, square = 0, near = 0;
    int count = 0;
    for (double y = -2; y < 2; y += 0.031)
        for (double z = -2; z < 2; z += 0.031)
        {
            const auto at = [&](double t, double side) {
                return 8 - scene.cast(t, {0, side, z}, Vector3d::UnitX(), 50)->range;
            };
            const double height = at(0, y);
            ASSERT_EQ(height, at(1.7, y));
            sum += height;
            square += height * height;
            near += std::abs(at(0, y + 0.001) - height);
            count++;
        }
    EXPECT_NEAR(sum / count, 0, 0.002);
    EXPECT_NEAR(std::sqrt(square / count), 0.03, 0.002);
    EXPECT_LT(near / count, 0.003) << "a millimetre aside is nearly as high";
    // Slanting rays meet the heights earlier.
    const Vector3d slant(0.5, std::sqrt(0.75), 0);
    square = 0;
    for (int i = 0; i < 4000; i++)
    {
        const double range = scene.cast(0, {0, -20 + 0.01 * i, 0.003 * i}, slant, 50)->range;
        square += std::pow((range - 16) * 0.5, 2) / 4000;
    }
    EXPECT_NEAR(std::sqrt(square), 0.03, 0.003);
    Scene leaf = wallAt(8, Material::Leaf);
    leaf.texture = scene.texture;
    EXPECT_EQ(leaf.cast(0, Vector3d::Zero(), Vector3d::UnitX(), 50)->range, 8);
}

TEST(Reality, GrassLetsLightThroughByBeerAndLambert)
{
    Scene scene = wallAt(8, Material::Soil);
    scene.texture.grass = 0.3;
    scene.texture.grass_path = 0.2;
    for (const double cosine : {1.0, 0.5})
    {
        const Vector3d direction(cosine, std::sqrt(1 - cosine * cosine), 0);
        double ground = 0, way = 0;
        constexpr int count = 20000;
        for (int i = 0; i < count; i++)
        {
            const auto hit = scene.cast(0.001 * i, Vector3d::Zero(), direction, 50);
            ASSERT_TRUE(hit);
            const double depth = hit->range - (8 - 0.3) / cosine;  // in the grass
            ASSERT_GE(depth, -1e-9);
            ASSERT_LE(depth, 0.3 / cosine + 1e-9);
            ground += hit->material == Material::Soil;
            way += std::min(depth, 0.3 / cosine) / count;
        }
        const double through = std::exp(-0.3 / cosine / 0.2);
        EXPECT_NEAR(ground / count, through, 4 * std::sqrt(through / count));
        EXPECT_NEAR(way, 0.2 * (1 - through), 0.005);  // mean of the way that is cut off
    }
    scene.texture.grass = 0;
    EXPECT_EQ(scene.cast(0, Vector3d::Zero(), Vector3d::UnitX(), 50)->range, 8);
}

TEST(Reality, ABeamInGrassIsPartlySentBackByBladesAndPartlyByTheGround)
{
    Scene scene = wallAt(4, Material::Soil);
    scene.texture.grass = 0.3;
    scene.texture.grass_path = 0.3;
    LidarConfig config = plain();
    config.T_imu_lidar = {};
    config.divergence = 3e-3;
    int ground = 0, within = 0;
    for (const LidarPoint& p : sweepOf(config, scene, still()).scan.points)
    {
        if (p.position.x() < 0.95F * distanceOf(p)) continue;  // nearly head-on
        ground += std::abs(p.position.x() - 4) < 1e-4F;
        within += p.position.x() > 3.75F && p.position.x() < 3.95F;
    }
    EXPECT_GT(within, 1000);
    // All three rays must reach the ground: exp(-3) of them do, 0.05.
    EXPECT_LT(ground, 0.15 * within);
    EXPECT_GT(ground, 10);
}

TEST(Reality, LeavesSwayAndTheRestOfTheWorldDoesNot)
{
    Mesh mesh;
    addQuad(mesh, {9, -5, -5}, {9, 5, -5}, {9, 5, 5}, {9, -5, 5}, 0.5F);
    const std::size_t trunk = mesh.triangles.size();
    for (int i = 0; i < 60; i++)
    {
        const double x = 0.5 * i;
        addQuad(mesh, {x, -0.2, -0.2}, {x, 0.2, -0.2}, {x, 0.2, 0.2}, {x, -0.2, 0.2}, 0.4F);
    }
    mesh.mark(trunk, Material::Leaf);
    Wind wind;
    wind.sway = 0.1;
    wind.frequency = 0.8;
    const std::size_t triangles = mesh.triangles.size();
    std::vector<Foliage> foliage = takeLeaves(mesh, wind, 7);
    EXPECT_EQ(mesh.triangles.size(), trunk);
    EXPECT_EQ(foliage.size(), 4U) << "a quarter of the leaves have the same phases";
    ASSERT_EQ(triangles, trunk + 120);

    constexpr int count = 10000;
    for (const Foliage& part : foliage)
    {
        Eigen::Vector2d sine = Eigen::Vector2d::Zero(), cosine = sine;
        for (int i = 0; i < count; i++)
        {
            const double t = 10.0 * i / count;
            sine += 2.0 / count * std::sin(2 * M_PI * 0.8 * t) * part.sway(t).head<2>();
            cosine += 2.0 / count * std::cos(2 * M_PI * 0.8 * t) * part.sway(t).head<2>();
            ASSERT_EQ(part.sway(t).z(), 0);
        }
        for (int axis : {0, 1}) EXPECT_NEAR(std::hypot(sine[axis], cosine[axis]), 0.1, 1e-4);
    }
    const Scene scene{RayCaster(mesh), {}, std::move(foliage)};
    for (const double t : {0.0, 0.4, 1.1})
    {
        const auto hit = scene.cast(t, {-1, 0, 0}, Vector3d::UnitX(), 50);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->material, Material::Leaf);
        // The first leaf is of the third part.
        EXPECT_NEAR(hit->range, 1 + scene.foliage[2].sway(t).x(), 1e-9);
        EXPECT_EQ(scene.cast(t, {-1, 3, 0}, Vector3d::UnitX(), 50)->range, 10);
    }
    EXPECT_NE(
        scene.cast(0.0, {-1, 0, 0}, Vector3d::UnitX(), 50)->range,
        scene.cast(0.4, {-1, 0, 0}, Vector3d::UnitX(), 50)->range);
}

TEST(Reality, AMirrorShowsWhatIsBeforeItBehindIt)
{
    Mesh mesh;
    addQuad(mesh, {2, -1, -1}, {2, 1, -1}, {2, 1, 1}, {2, -1, 1}, 0.1F);
    mesh.mark(0, Material::Mirror);
    addQuad(mesh, {-3, -20, -20}, {-3, 20, -20}, {-3, 20, 20}, {-3, -20, 20}, 0.5F);
    const Scene scene{RayCaster(mesh), {}};
    for (const double angle : {0.0, 0.2, -0.3})
    {
        const Vector3d direction(std::cos(angle), std::sin(angle), 0);
        const auto hit = scene.cast(0, Vector3d::Zero(), direction, 50);
        ASSERT_TRUE(hit);
        // Whatever is at x = -3 is seen at x = 7, and its surface looks this way.
        EXPECT_NEAR(hit->range * direction.x(), 7, 1e-9);
        EXPECT_LT((hit->normal + Vector3d::UnitX()).norm(), 1e-12);
        EXPECT_NEAR(hit->reflectivity, 0.5 * 0.81, 1e-6);
    }
    EXPECT_FALSE(scene.cast(0, Vector3d::Zero(), Vector3d::UnitX(), 6.9)) << "out of range";
    // Beside the mirror there is nothing.
    EXPECT_FALSE(scene.cast(0, {0, 5, 0}, Vector3d::UnitX(), 50));

    addQuad(mesh, {-2, -1, -1}, {-2, 1, -1}, {-2, 1, 1}, {-2, -1, 1}, 0.1F);
    mesh.mark(mesh.triangles.size() - 2, Material::Mirror);
    const Scene between{RayCaster(mesh), {}};
    EXPECT_FALSE(between.cast(0, Vector3d::Zero(), Vector3d::UnitX(), 1000)) << "for ever";
}

TEST(Reality, AShareOfTheWindowsAreMirrors)
{
    const auto count = [](const WorldConfig& config, Material material)
    {
        const World world = makeWorld(config);
        const auto& m = world.mesh.materials;
        return std::count(m.begin(), m.end(), material);
    };
    for (const WorldType type :
         {WorldType::Street, WorldType::Halls, WorldType::Storeys, WorldType::Stairwell})
    {
        SCOPED_TRACE(static_cast<int>(type));
        WorldConfig config;
        config.type = type;
        EXPECT_EQ(count(config, Material::Mirror) + count(config, Material::Pane), 0);
        config.mirrors = 1;
        const auto all = static_cast<double>(count(config, Material::Mirror));
        ASSERT_GT(all, 3);
        config.mirrors = 0.4;
        const auto some = static_cast<double>(count(config, Material::Mirror));
        EXPECT_NEAR(some / all, 0.4, 4 * std::sqrt(0.24 / (all / 2)));
        EXPECT_EQ(std::fmod(some, 2), 0) << "whole panes";
    }
}

TEST(Reality, CompanionsWalkWithTheBody)
{
    const MotionConfig motion = motionPreset(MotionPreset::Walk);
    const Course course = makeCourse(motion, smallWorld().route, 12, 4);
    Companions companions;
    companions.ahead = 1;
    companions.beside = 2;
    companions.distance = 1.6;
    const auto movers = makeCompanions(companions, course, 3);
    ASSERT_EQ(movers.size(), 3U);
    const Motion body = makeMotion(motion, course, 3);
    double rest = 0;
    for (std::size_t k = 0; k < movers.size(); k++)
        for (double t = 0; t < 12; t += 0.1)
        {
            const Pose T = body.poseAt(t);
            Vector3d to = movers[k].motion().poseAt(t).p - T.p;
            to.z() = 0;
            const double nominal = k == 0 ? 1.6 : 0.8;
            EXPECT_NEAR(to.norm(), nominal, 0.45) << k << " at " << t;
            if (t < 4 && k == 0)
                rest = std::max(
                    rest, (movers[k].motion().poseAt(t).p - movers[k].motion().poseAt(0).p).norm());
        }
    EXPECT_GT(rest, 0.01) << "they shift about while the body rests";
    EXPECT_LT(rest, 0.5);
}

TEST(Reality, WhatCannotBeIsRefusedByItsKey)
{
    const std::map<std::string, std::vector<std::string>> wrong{
        {"'imu.clock_drift'", {"imu.clock_drift=1"}},
        {"'imu.warming'", {"imu.warming=5"}},  // an industrial IMU has no coefficients
        {"'imu.warming_time'", {"imu.warming_time=0"}},
        {"'imu.gyro_temperature'", {"imu.gyro_temperature=nan"}},
        {"'faults.imu_stamps.jitter'", {"faults.imu_stamps.jitter=-0.001"}},
        {"'faults.lidar_stamps.step'", {"faults.lidar_stamps.step=1e9"}},
        {"'lidar.intensity_error'", {"lidar.intensity_error=2"}},
        {"'lidar.incidence_error'", {"lidar.incidence_error=0.5", "lidar.divergence=0"}},
        {"'lidar.packet_loss.share'", {"lidar.packet_loss.share=0.6"}},
        {"'lidar.packet_loss.burst'", {"lidar.packet_loss.burst=0.5"}},
        {"'lidar.soft_mount.frequency'", {"lidar.soft_mount.angle=0.01"}},
        {"'lidar.soft_mount.displacement'", {"lidar.soft_mount.displacement=-1"}},
        {"'lidar.mount_error.roll'", {"lidar.mount_error.roll=300"}},
        {"'lidar.own_body'", {"lidar.own_body=horse"}},
        {"'lidar.min_range'", {"lidar.min_range=200"}},
        {"'weather.rain'", {"weather.rain=-3"}},
        {"'weather.near_returns'", {"weather.near_returns=1"}},
        {"'weather'", {"weather.rain=3", "lidar.detection_range=0"}},
        {"'world.roughness'", {"world.roughness=inf"}},
        {"'world.roughness_length'", {"world.roughness_length=0"}},
        {"'world.grass'", {"world.grass=0.2"}},  // none in a hall
        {"'world.grass_path'", {"world.type=field", "world.grass_path=0"}},
        {"'world.wind'", {"world.wind.sway=0.1"}},
        {"'world.wind.frequency'", {"world.type=forest", "world.wind.frequency=0"}},
        {"'world.mirrors'", {"world.type=storeys", "world.mirrors=1.5"}},
        {"'world.companions.ahead'", {"world.companions.ahead=-1"}},
        {"'world.companions'", {"world.companions.ahead=1", "motion.type=replay"}},
    };
    for (const auto& [key, settings] : wrong)
    {
        std::vector<std::string> all = settings;
        if (settings.back() == "motion.type=replay") all.push_back("motion.file=x.tum");
        EXPECT_THAT(refusal(all), HasSubstr(key));
    }
}
