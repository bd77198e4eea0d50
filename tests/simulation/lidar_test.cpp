#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using namespace taut::simulation::test;

namespace
{
LidarConfig noiseFree(LidarType type = LidarType::Vlp16)
{
    LidarConfig config = lidarPreset(type);
    config.range_noise = config.range_step = config.dropout = config.detection_range = 0;
    config.divergence = 0;
    config.T_imu_lidar = {expSO3(Vector3d(0.1, -0.2, 0.3)), Vector3d(0.1, 0.05, -0.15)};
    return config;
}
}  // namespace

TEST(Lidar, NoiseFreePointsLieOnSurfaces)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    Executor executor(1);
    const LidarConfig config = noiseFree();
    const Lidar lidar(config, 1);
    for (const int k : {0, 20, 41})
    {
        const SimulatedScan s = lidar.sweep(k, motion, scene, executor);
        ASSERT_GT(s.scan.points.size(), 20000U);
        for (std::size_t i = 0; i < s.scan.points.size(); i += 37)
        {
            EXPECT_LT(scene.world.clearance(s.surface[i], 0.01), 1e-6);
            // The stored point carries the rounding to float, and nothing more.
            const Pose T = motion.poseAt(toSeconds(s.scan.timeOf(s.scan.points[i])));
            const Vector3d stored =
                T * config.T_imu_lidar * s.scan.points[i].position.cast<double>();
            EXPECT_LT((stored - s.surface[i]).norm(), 3e-6);
        }
    }
}

TEST(Lidar, BeamsOfAnOusterStartOffItsAxis)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    Executor executor(1);
    const LidarConfig config = noiseFree(LidarType::Os1_64);
    const SimulatedScan s = Lidar(config, 1).sweep(40, motion, scene, executor);
    for (std::size_t i = 0; i < s.scan.points.size(); i += 37)
    {
        const Pose T = motion.poseAt(toSeconds(s.scan.timeOf(s.scan.points[i])));
        const Vector3d stored = T * config.T_imu_lidar * s.scan.points[i].position.cast<double>();
        EXPECT_LT((stored - s.surface[i]).norm(), 3e-6);
        EXPECT_LT(scene.world.clearance(s.surface[i], 0.01), 1e-6);
    }
    for (const auto& [rows, offset] : {std::pair{64, 12.163e-3}, std::pair{128, 15.806e-3}})
        for (const Shot& shot : makeOs1Pattern(rows, 10)->sweep(3))
        {
            ASSERT_NEAR(shot.origin.norm(), offset, 1e-9);
            ASSERT_EQ(shot.origin.z(), 0);
            // Where the head looks: between the rows that are staggered to both sides of it.
            const Vector3d ahead(shot.direction.x(), shot.direction.y(), 0);
            ASSERT_GT(shot.origin.dot(ahead.normalized()), offset * std::cos(4.3 * M_PI / 180));
        }
    EXPECT_TRUE(makeVlp16Pattern(10)->sweep(0)[5].origin.isZero());
}

TEST(Lidar, TruthIsThePointSeenFromTheEndOfTheScan)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    Executor executor(1);
    const SimulatedScan s = Lidar(noiseFree(), 1).sweep(40, motion, scene, executor);
    const Pose T_end = motion.poseAt(toSeconds(s.scan.end));
    Time last = 0;
    for (std::size_t i = 0; i < s.truth.size(); i++)
    {
        EXPECT_LT((T_end * s.truth[i].cast<double>() - s.surface[i]).norm(), 4e-6);
        last = std::max(last, s.scan.timeOf(s.scan.points[i]));
    }
    EXPECT_EQ(last, s.scan.end);
}

TEST(Lidar, ThreadsDoNotChangeTheBits)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Fast, 4, 1);
    LidarConfig config = lidarPreset(LidarType::Vlp16);
    const Lidar lidar(config, 9);
    Executor one(1), three(3);
    const SimulatedScan a = lidar.sweep(25, motion, scene, one);
    const SimulatedScan b = lidar.sweep(25, motion, scene, three);
    ASSERT_EQ(a.scan.points.size(), b.scan.points.size());
    for (std::size_t i = 0; i < a.scan.points.size(); i++)
    {
        ASSERT_EQ(a.scan.points[i].position, b.scan.points[i].position);
        ASSERT_EQ(a.scan.points[i].offset, b.scan.points[i].offset);
        ASSERT_EQ(a.truth[i], b.truth[i]);
    }
    const SimulatedScan other = Lidar(config, 10).sweep(25, motion, scene, one);
    EXPECT_NE(a.truth, other.truth);
}

TEST(Lidar, RangeNoiseHasTheDeviationAskedFor)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Calm, 4, 3);
    LidarConfig config = noiseFree();
    Executor executor(1);
    const SimulatedScan clean = Lidar(config, 1).sweep(3, motion, scene, executor);
    config.range_noise = 0.03;
    const SimulatedScan noisy = Lidar(config, 1).sweep(3, motion, scene, executor);
    ASSERT_EQ(clean.scan.points.size(), noisy.scan.points.size());
    double sum = 0;
    for (std::size_t i = 0; i < clean.scan.points.size(); i++)
        sum += std::pow(
            noisy.scan.points[i].position.norm() - clean.scan.points[i].position.norm(), 2);
    const double deviation = std::sqrt(sum / static_cast<double>(clean.scan.points.size()));
    EXPECT_NEAR(deviation, 0.03, 0.001);
}

TEST(Lidar, WithoutErrorsAPointIsRecordedAlongItsShotToTheBit)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Fast, 4, 1);
    Executor executor(1);
    const LidarConfig config = noiseFree();
    const SimulatedScan s = Lidar(config, 1).sweep(20, motion, scene, executor);
    const std::vector<Shot> shots = makeVlp16Pattern(10)->sweep(20);
    ASSERT_EQ(s.scan.points.size(), shots.size());
    for (std::size_t i = 0; i < shots.size(); i++)
    {
        const double t = toSeconds(Lidar::kStart + shots[i].t);
        const Pose T = motion.poseAt(t) * config.T_imu_lidar;
        const auto hit = scene.cast(t, T.p, T.R * shots[i].direction, config.max_range);
        ASSERT_TRUE(hit);
        ASSERT_EQ(
            s.scan.points[i].position, (hit->range * shots[i].direction).cast<float>().eval());
    }
    EXPECT_EQ(s.truth, undistorted(s.scan, motion));
}

TEST(Lidar, EveryRingHasItsOwnElevationForGood)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Calm, 4, 3);
    LidarConfig config = noiseFree(LidarType::Os1_128);
    config.beam_error = 2e-3;
    Executor executor(1);
    const Lidar lidar(config, 5);
    double sum = 0;
    for (int ring = 0; ring < 128; ring++)
        sum += std::pow(lidar.beamErrors().elevation(static_cast<std::uint16_t>(ring)), 2);
    EXPECT_NEAR(std::sqrt(sum / 128), 2e-3, 3e-4);
    EXPECT_NE(lidar.beamErrors().elevation(3), Lidar(config, 6).beamErrors().elevation(3));

    for (const int k : {0, 30})
    {
        const SimulatedScan s = lidar.sweep(k, motion, scene, executor);
        ASSERT_GT(s.scan.points.size(), 100000U);
        const std::vector<Shot> shots = makeOs1Pattern(128, 10)->sweep(k);
        for (std::size_t i = 0; i < shots.size(); i += 997)
        {
            const LidarPoint& p = s.scan.points[i];
            const Pose T =
                motion.poseAt(toSeconds(s.scan.timeOf(p))) * config.T_imu_lidar;  // world <- lidar
            const Vector3d seen = (T.inverse() * s.surface[i] - shots[i].origin).normalized();
            const double off = std::asin(seen.z()) - std::asin(shots[i].direction.z());
            ASSERT_EQ(p.ring, shots[i].ring);
            EXPECT_NEAR(off, lidar.beamErrors().elevation(p.ring), 1e-9);
            // What is recorded lies along the design.
            const Vector3d recorded = p.position.cast<double>() - shots[i].origin;
            EXPECT_LT(recorded.normalized().cross(shots[i].direction).norm(), 2e-6);
        }
    }
}

TEST(Lidar, RangeErrorsAreConstantPerRingAndTheNoiseStaysAsItIs)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Calm, 4, 3);
    LidarConfig config = noiseFree(LidarType::Os1_128);
    config.range_noise = 0.01;
    Executor executor(1);
    const Lidar clean(config, 5);
    config.beam_range_error = 0.03;
    config.range_bias = 0.2;
    const Lidar biased(config, 5);
    double sum = 0, square = 0;
    for (int ring = 0; ring < 128; ring++)
    {
        const double error = biased.beamErrors().range(static_cast<std::uint16_t>(ring));
        sum += error / 128;
        square += std::pow(error - 0.2, 2) / 128;
    }
    EXPECT_NEAR(sum, 0.2, 0.01);
    EXPECT_NEAR(std::sqrt(square), 0.03, 0.005);

    for (const int k : {0, 30})
    {
        const SimulatedScan a = clean.sweep(k, motion, scene, executor);
        const SimulatedScan b = biased.sweep(k, motion, scene, executor);
        ASSERT_EQ(a.scan.points.size(), b.scan.points.size());
        for (std::size_t i = 0; i < a.scan.points.size(); i += 97)
        {
            const LidarPoint &p = a.scan.points[i], &q = b.scan.points[i];
            EXPECT_NEAR((q.position - p.position).norm(), biased.beamErrors().range(p.ring), 3e-6);
        }
    }
}

TEST(Lidar, TruthIsFreeOfTheErrorsOfTheBeams)
{
    const Scene scene = smallScene();
    const Motion motion = motionOf(MotionPreset::Violent, 6, 1);
    Executor executor(1);
    for (const LidarType type : {LidarType::Vlp16, LidarType::Os1_64, LidarType::Rosette})
    {
        SCOPED_TRACE(static_cast<int>(type));
        LidarConfig config = noiseFree(type);
        config.beam_error = 5e-3;
        config.beam_range_error = 0.03;
        config.range_bias = 0.1;
        const SimulatedScan s = Lidar(config, 1).sweep(40, motion, scene, executor);
        const Pose T_end = motion.poseAt(toSeconds(s.scan.end));
        for (std::size_t i = 0; i < s.truth.size(); i += 7)
            EXPECT_LT((T_end * s.truth[i].cast<double>() - s.surface[i]).norm(), 1e-5);
        EXPECT_GT((s.truth[0] - undistorted(s.scan, motion)[0]).norm(), 0.02F);
    }
}

TEST(Lidar, FarAndGrazingShotsAreLostFirst)
{
    Mesh mesh;
    addQuad(mesh, {-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0}, 0.5F);
    const Scene scene{RayCaster(mesh), {}};
    const Motion motion = motionOf(MotionPreset::Calm, 2, 2);
    LidarConfig config = noiseFree();
    Executor executor(1);
    const auto count = [&](float from, float to, const LidarConfig& c)
    {
        std::size_t n = 0;
        for (const LidarPoint& p : Lidar(c, 1).sweep(0, motion, scene, executor).scan.points)
            n += p.position.norm() >= from && p.position.norm() < to;
        return static_cast<double>(n);
    };
    LidarConfig real = config;
    real.detection_range = 60;
    EXPECT_GT(count(0, 8, real), 0.98 * count(0, 8, config));
    EXPECT_LT(count(30, 100, real), 0.2 * count(30, 100, config));
    EXPECT_GT(count(30, 100, config), 100);
}

TEST(LidarPattern, Vlp16FiresAsItsManualSays)
{
    const auto pattern = makeVlp16Pattern(10);
    const auto shots = pattern->sweep(0);
    EXPECT_EQ(shots.size(), 1809U * 16);  // 0.1 s / 55.296 us
    EXPECT_NEAR(shots[1].direction.z(), std::sin(M_PI / 180), 1e-12);
    EXPECT_EQ(shots[15].t, 34600);  // 15 * 2.304 us in ticks of 100 ns
    EXPECT_EQ(shots[16].t, 55300);
    // Clockwise from +x.
    EXPECT_NEAR(shots[0].direction.x(), std::cos(15 * M_PI / 180), 1e-9);
    EXPECT_LT(shots[1600].direction.y(), -0.1);
    // Sweeps join without overlap or gap.
    const auto next = pattern->sweep(1);
    EXPECT_GT(next.front().t, shots.back().t);
    EXPECT_LT(next.front().t - shots.back().t, 56000);
}

TEST(LidarPattern, EverySensorSeesWhatItsDataSheetSays)
{
    struct Facts
    {
        std::unique_ptr<LidarPattern> pattern;
        int rings;
        double lowest, highest;  // degrees
        double shots_a_second;
    };
    std::vector<Facts> all;
    all.push_back({makeVlp16Pattern(10), 16, -15, 15, 16 / 55.296e-6});
    all.push_back({makeHdl32Pattern(10), 32, -30.67, 10.67, 32 / 46.08e-6});
    all.push_back({makeHdl64Pattern(10), 64, -24.33, 2, 64 / 48e-6});
    all.push_back({makeOs1Pattern(64, 10), 64, -16.6, 16.6, 655360});
    all.push_back({makeOs1Pattern(128, 10), 128, -21.4, 21.4, 1310720});
    for (const Facts& facts : all)
    {
        SCOPED_TRACE(facts.rings);
        EXPECT_EQ(facts.pattern->rings(), facts.rings);
        double lowest = 90, highest = -90, shots = 0;
        Duration last = -1;
        for (int k = 0; k < 5; k++)
            for (const Shot& shot : facts.pattern->sweep(k))
            {
                EXPECT_NEAR(shot.direction.norm(), 1, 1e-12);
                EXPECT_LT(shot.ring, facts.rings);
                EXPECT_GE(shot.t, last);
                EXPECT_EQ(shot.t % 100, 0);
                last = shot.t;
                const double elevation = std::asin(shot.direction.z()) * 180 / M_PI;
                lowest = std::min(lowest, elevation);
                highest = std::max(highest, elevation);
                shots++;
            }
        EXPECT_NEAR(lowest, facts.lowest, 0.01);
        EXPECT_NEAR(highest, facts.highest, 0.01);
        EXPECT_NEAR(shots / 0.5, facts.shots_a_second, 1e-3 * facts.shots_a_second);
    }
}

TEST(LidarPattern, TheRosetteFillsACircleAndNeverRepeats)
{
    const auto pattern = makeRosettePattern(10);
    const auto first = pattern->sweep(0), second = pattern->sweep(1);
    ASSERT_EQ(first.size(), 10000U);
    double widest = 0, same = 0;
    for (std::size_t i = 0; i < first.size(); i++)
    {
        widest = std::max(widest, std::acos(first[i].direction.x()) * 180 / M_PI);
        same += (first[i].direction - second[i].direction).norm() < 1e-3;
    }
    EXPECT_NEAR(widest, 35.2, 0.01);
    EXPECT_LT(same, 100);
}

TEST(Lidar, ABeamOverAnEdgeMixesWhatIsNearAndSplitsWhatIsFar)
{
    // A step in a wall: 5 m away on the left, farther on the right.
    const auto rangesAt = [](double step, double divergence)
    {
        Mesh mesh;
        addQuad(mesh, {5, 0, -4}, {5, 4, -4}, {5, 4, 4}, {5, 0, 4}, 0.5F);
        addQuad(
            mesh, {5 + step, -4, -4}, {5 + step, 0, -4}, {5 + step, 0, 4}, {5 + step, -4, 4}, 0.5F);
        const Scene scene{RayCaster(mesh), {}};
        LidarConfig config = noiseFree();
        config.T_imu_lidar = {};
        config.divergence = divergence;
        const Motion still(std::vector<Pose>(10), 1);
        Executor executor(1);
        std::vector<float> depths;
        for (const LidarPoint& p : Lidar(config, 1).sweep(0, still, scene, executor).scan.points)
            depths.push_back(p.position.x());
        return depths;
    };
    const auto between = [](const std::vector<float>& depths, double near, double far)
    {
        return std::count_if(
            depths.begin(), depths.end(), [&](float d) { return d > near && d < far; });
    };
    EXPECT_EQ(between(rangesAt(0.3, 0), 5.02, 5.28), 0);
    EXPECT_GT(between(rangesAt(0.3, 3e-3), 5.02, 5.28), 10);
    EXPECT_EQ(between(rangesAt(2, 3e-3), 5.02, 6.98), 0);
}
