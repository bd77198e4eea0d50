#include "taut/odometry/Pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "recording.h"
#include "taut/core/WarningLog.h"
#include "taut/odometry/registerAll.h"

using namespace taut;
using namespace taut::test;

namespace
{
struct Streams
{
    Recording recording;
    ImuSamples imu;
    std::vector<Scan> scans;
};

/** The recording of a brisk motion by hand, made once. */
const Streams& hand()
{
    static const Streams streams = []
    {
        const Recording r;
        return Streams{r, r.imu(), r.scans()};
    }();
    return streams;
}

/** The same from the midst of the motion on. */
Streams handInMotion()
{
    Streams moving = hand();
    const Time begin = moving.recording.start + fromSeconds(2.2);
    moving.imu.erase(
        std::remove_if(
            moving.imu.begin(), moving.imu.end(), [&](const ImuSample& s) { return s.t < begin; }),
        moving.imu.end());
    moving.scans.erase(moving.scans.begin(), moving.scans.begin() + 22);
    return moving;
}

struct Outcome
{
    WarningLog log;
    std::vector<ScanResult> results;
    /** What is final of each scan. */
    struct Final
    {
        NavState state;
        std::vector<Vector3d> points;
    };
    std::vector<Final> refined;
    std::vector<Lost> lost;
    std::vector<Recovered> recovered;
    bool with_imu = false;
    std::optional<Initialization> initialization;
    std::size_t map_size = 0, most_waiting = 0;

    std::size_t warnings() const { return log.counts().size(); }

    /** Root mean square of the position's error over all scans [m]. The estimated world is the true
     * one: both begin at the first pose. */
    double error(const Recording& truth) const
    {
        double sum = 0;
        for (const ScanResult& r : results)
        {
            const NavState& x = r.estimate.state;
            sum += (x.T_world_imu.p - truth.truth(x.t).T_world_imu.p).squaredNorm();
        }
        return std::sqrt(sum / static_cast<double>(results.size()));
    }
};

/** Feeds both streams in the order of time, as a player would. */
Outcome run(
    const Streams& streams, const std::string& estimation = "{}", int threads = 1,
    bool keep_undistorted = false, const std::string& on_motion = "start", double share = 1)
{
    registerAll();
    ConfigSection root(parseYaml(
        "initialization: {rest_duration: 1.2, min_rest: 0.5, on_motion: " + on_motion +
        "}\n"
        "lidar: {max_range: 30}\n"
        "estimation: " +
        estimation + "\n"));
    OdometryConfig config = OdometryConfig::read(root);
    config.keep_undistorted = keep_undistorted;
    root.rejectUnknown();
    Executor executor(threads);
    Outcome out;
    Pipeline pipeline(
        config, executor, out.log.sink(),
        [&](const Event& event)
        {
            if (const auto* estimated = std::get_if<Estimated>(&event))
                out.results.push_back(estimated->result);
            else if (const auto* refined = std::get_if<Refined>(&event))
                out.refined.push_back({refined->state, refined->points()});
            else if (const auto* lost = std::get_if<Lost>(&event))
                out.lost.push_back(*lost);
            else if (const auto* recovered = std::get_if<Recovered>(&event))
                out.recovered.push_back(*recovered);
        });
    pipeline.setShare(share);
    auto sample = streams.imu.begin();
    for (const Scan& scan : streams.scans)
    {
        for (; sample != streams.imu.end() && sample->t <= scan.end; ++sample)
            pipeline.add(*sample);
        pipeline.add(scan);
        out.most_waiting = std::max(out.most_waiting, pipeline.waiting());
    }
    for (; sample != streams.imu.end(); ++sample) pipeline.add(*sample);
    pipeline.finish();
    out.with_imu = pipeline.withImu();
    out.initialization = pipeline.initialization();
    out.map_size = pipeline.mapSize();
    return out;
}

void expectEqual(const Outcome& a, const Outcome& b)
{
    ASSERT_EQ(a.results.size(), b.results.size());
    for (std::size_t i = 0; i < a.results.size(); i++)
    {
        const NavEstimate &x = a.results[i].estimate, &y = b.results[i].estimate;
        EXPECT_EQ(x.state.T_world_imu.p, y.state.T_world_imu.p);
        EXPECT_EQ(x.state.T_world_imu.R, y.state.T_world_imu.R);
        EXPECT_EQ(x.state.bias_gyro, y.state.bias_gyro);
        EXPECT_EQ(x.covariance, y.covariance);
        EXPECT_EQ(a.results[i].points, b.results[i].points);
    }
}
}  // namespace

TEST(Pipeline, FollowsAMotionByHandToMillimetres)
{
    for (const std::string mode : {"bridge", "iterated", "iterated-imu", "imu"})
    {
        const Outcome done = run(hand(), "{undistortion: " + mode + "}");
        EXPECT_LT(done.error(hand().recording), 0.006) << mode;
        RecordProperty("ate_mm_" + mode, std::to_string(1e3 * done.error(hand().recording)));
        EXPECT_EQ(done.results.size(), hand().scans.size()) << mode;
        EXPECT_EQ(done.warnings(), 0u) << mode;
        EXPECT_TRUE(done.with_imu);
        EXPECT_TRUE(done.initialization->at_rest);
        for (const ScanResult& r : done.results)
        {
            EXPECT_EQ(r.report.lidar_used, &r != &done.results.front());  // the first has no map
            EXPECT_GT(r.estimate.covariance.diagonal().minCoeff(), 0);
        }
    }
}

TEST(Pipeline, WithoutUndistortionTheErrorIsManyTimesLarger)
{
    const double none = run(hand(), "{undistortion: none}").error(hand().recording);
    const double bridge = run(hand(), "{undistortion: bridge}").error(hand().recording);
    EXPECT_GT(none, 4 * bridge);
}

TEST(Pipeline, AGyroAtTheEndOfItsRangeIsFollowed)
{
    // The body turns by up to 1.5 rad/s.
    Streams streams = hand();
    for (ImuSample& s : streams.imu) s.gyro = s.gyro.cwiseMin(0.8).cwiseMax(-0.8);
    const Outcome unaware = run(streams);
    const Outcome done = run(streams, "{}\nimu: {gyro_range: 0.8}");
    EXPECT_LT(done.error(hand().recording), 0.01);
    EXPECT_LT(done.error(hand().recording), 0.5 * unaware.error(hand().recording));
    EXPECT_GT(done.log.count("gyro_clipped"), 0u);
    EXPECT_EQ(done.log.counts().size(), 1u);
    RecordProperty("ate_mm", std::to_string(1e3 * done.error(hand().recording)));
    RecordProperty("ate_mm_unaware", std::to_string(1e3 * unaware.error(hand().recording)));
}

TEST(Pipeline, EstimatesVelocityAndGyroBias)
{
    const Outcome done = run(hand());
    const NavState& x = done.results.back().estimate.state;
    const NavState truth = hand().recording.truth(x.t);
    EXPECT_LT((x.v_world - truth.v_world).norm(), 0.05);
    EXPECT_LT((x.bias_gyro - truth.bias_gyro).norm(), 2e-3);
    EXPECT_LT(logSO3(x.T_world_imu.R.transpose() * truth.T_world_imu.R).norm(), 5e-3);
}

TEST(Pipeline, IsBitEqualWithAnyNumberOfThreads)
{
    Streams first = hand();
    first.scans.resize(25);
    expectEqual(run(first, "{}", 1), run(first, "{}", 2));
}

TEST(Pipeline, WritesPointsWhereTheyWere)
{
    const Outcome done = run(hand());
    const Box room = Recording::room().room;
    std::size_t outside = 0, all = 0;
    for (const ScanResult& r : done.results)
        for (const Vector3d& p : r.points)
        {
            all++;
            const double beyond = std::max((p - room.max).maxCoeff(), (room.min - p).maxCoeff());
            outside += beyond > 0.05;  // five times the noise of a range
        }
    EXPECT_GT(all, hand().scans.size() * 3000);
    EXPECT_LT(static_cast<double>(outside), 1e-3 * static_cast<double>(all));
}

TEST(Pipeline, UndistortsEveryPointOnRequest)
{
    Streams brisk = hand();
    brisk.scans.resize(40);
    // RMSE over all scans of the distance to where the true motion takes the points [m].
    const auto errorOf = [&brisk](const std::string& mode)
    {
        const Outcome done = run(brisk, "{undistortion: " + mode + "}", 2, true);
        double sum = 0;
        std::size_t points = 0;
        for (std::size_t k = 0; k < done.results.size(); k++)
        {
            const Scan& raw = brisk.scans[k];
            const std::vector<Eigen::Vector3f>& undistorted = done.results[k].undistorted;
            if (undistorted.size() != raw.points.size()) return -1.0;
            const Pose T_end_world = brisk.recording.truth(raw.end).T_world_imu.inverse();
            for (std::size_t i = 0; i < raw.points.size(); i += 7)
            {
                const LidarPoint& p = raw.points[i];
                const Pose T = T_end_world * brisk.recording.truth(raw.timeOf(p)).T_world_imu;
                const Vector3d in_imu = raw.T_imu_lidar * Vector3d(p.position.cast<double>());
                if (!undistorted[i].allFinite()) continue;
                sum += (T * in_imu - undistorted[i].cast<double>()).squaredNorm();
                points++;
            }
        }
        return points < 20'000 ? -1.0 : std::sqrt(sum / static_cast<double>(points));
    };
    for (const std::string mode : {"bridge", "iterated", "iterated-imu", "imu"})
    {
        const double error = errorOf(mode);
        EXPECT_GT(error, 0) << mode;
        EXPECT_LT(error, 0.004) << mode;
    }
    EXPECT_GT(errorOf("none"), 0.05);
    EXPECT_TRUE(run(brisk).results.back().undistorted.empty());
}

TEST(Pipeline, APointThatIsNotUsableIsNotUndistorted)
{
    Streams holes = hand();
    holes.scans.resize(20);
    holes.scans[17].points[5].position *= 100.0F;  // out of range
    const Outcome done = run(holes, "{}", 1, true);
    EXPECT_TRUE(done.results[17].undistorted[5].array().isNaN().all());
    EXPECT_TRUE(done.results[17].undistorted[6].allFinite());
}

TEST(Pipeline, ScansBeforeTheImuAreLeftOut)
{
    Streams late = hand();
    late.imu.erase(late.imu.begin(), late.imu.begin() + 70);  // 0.35 s
    const Outcome done = run(late);
    EXPECT_TRUE(done.with_imu);
    EXPECT_GE(done.results.size(), late.scans.size() - 4);
    EXPECT_LT(done.results.size(), late.scans.size());
    EXPECT_GT(done.results.front().estimate.state.t, late.imu.front().t);
    EXPECT_LT(done.error(late.recording), 0.01);
}

TEST(Pipeline, AGapInTheImuIsReportedAndSurvived)
{
    Streams gap = hand();
    gap.imu.erase(gap.imu.begin() + 700, gap.imu.begin() + 735);  // 180 ms, in motion
    const Outcome done = run(gap);
    EXPECT_EQ(done.log.count("imu_gap"), 1u);
    EXPECT_EQ(done.log.kept().front().t, gap.imu[699].t);
    EXPECT_EQ(done.results.size(), gap.scans.size());
    EXPECT_LT(done.error(gap.recording), 0.03);
}

namespace
{
/** A motion by hand at a third of the pace, which constant velocity can follow. */
Streams slowHand()
{
    Recording slow;
    slow.swing = 0.3;
    return {slow, slow.imu(), slow.scans()};
}

void eraseImu(Streams& streams, double from, double to)
{
    const Time begin = streams.recording.start + fromSeconds(from);
    const Time end = streams.recording.start + fromSeconds(to);
    streams.imu.erase(
        std::remove_if(
            streams.imu.begin(), streams.imu.end(),
            [&](const ImuSample& s) { return s.t > begin && s.t < end; }),
        streams.imu.end());
}
}  // namespace

TEST(Pipeline, AnImuThatDiesIsReportedAndTheLidarGoesOn)
{
    Streams dying = slowHand();
    eraseImu(dying, 2.5, 100);
    const Outcome done = run(dying);
    EXPECT_EQ(done.results.size(), dying.scans.size());
    EXPECT_EQ(done.log.count("imu_silent"), 1u);
    EXPECT_EQ(done.log.kept().front().t, dying.imu.back().t);
    EXPECT_LT(done.error(dying.recording), 0.006);
    ASSERT_EQ(done.lost.size(), 1u);
    EXPECT_EQ(done.lost[0].cause, "imu_silent");
    EXPECT_NEAR(toSeconds(done.lost[0].t - dying.imu.back().t), 0.15, 0.06);
    EXPECT_TRUE(done.recovered.empty());
    // Held while a sample may still come: a second of scans, not the rest of the recording.
    EXPECT_LE(done.most_waiting, 13u);
    expectEqual(done, run(dying, "{}", 2));
}

TEST(Pipeline, AnImuThatComesBackIsUsedAgain)
{
    Streams gap = slowHand();
    eraseImu(gap, 2.2, 3.9);
    const Outcome done = run(gap);
    EXPECT_EQ(done.results.size(), gap.scans.size());
    EXPECT_EQ(done.log.count("imu_silent"), 1u);
    EXPECT_EQ(done.log.count("imu_back"), 1u);
    EXPECT_LT(done.error(gap.recording), 0.006);
    EXPECT_TRUE(done.results.back().with_imu);
    EXPECT_FALSE(done.results[33].with_imu);
    ASSERT_EQ(done.recovered.size(), 1u);
    EXPECT_NEAR(toSeconds(done.recovered[0].t - gap.recording.start), 4.05, 0.1);
}

TEST(Pipeline, AnImuThatDiesWhileARestIsWaitedForIsNotWaitedFor)
{
    Streams dying = slowHand();
    eraseImu(dying, 0.8, 100);
    const Outcome done = run(dying);
    EXPECT_EQ(done.log.count("imu_silent"), 1u);
    EXPECT_GE(done.results.size(), dying.scans.size() - 1);
    EXPECT_LT(done.error(dying.recording), 0.01);
}

TEST(Pipeline, ALidarThatEndsIsReported)
{
    Streams ends = hand();
    ends.scans.resize(30);
    const Outcome done = run(ends);
    EXPECT_EQ(done.log.count("lidar_ended"), 1u);
    EXPECT_EQ(done.log.kept().back().t, ends.scans.back().end);
}

TEST(Pipeline, HoldsABoundedPastWhileItWaitsForARest)
{
    Recording moving;
    moving.rest = 0;
    moving.duration = 6;
    const Streams never{moving, moving.imu(), moving.scans()};
    const Outcome done = run(never, "{}", 1, false, "wait");
    EXPECT_EQ(done.log.count("no_rest"), 1u);
    EXPECT_TRUE(done.results.empty());
    EXPECT_LE(done.most_waiting, 15u);
}

TEST(Pipeline, TellsEachStateAgainWhenItIsFinal)
{
    const Outcome done = run(hand());
    ASSERT_EQ(done.refined.size(), done.results.size());
    for (std::size_t k = 0; k < done.results.size(); k++)
    {
        const NavState& expected = k + 1 < done.results.size() ? done.results[k + 1].previous
                                                               : done.results[k].estimate.state;
        EXPECT_EQ(done.refined[k].state.T_world_imu.p, expected.T_world_imu.p);
        EXPECT_EQ(done.refined[k].points.size(), done.results[k].points.size());
    }
}

TEST(Pipeline, TheFinalPointsAreNearerToWhereTheyWere)
{
    const Streams& brisk = hand();
    const Outcome done = run(brisk);
    double filtered = 0, refined = 0, n = 0;
    for (std::size_t k = 20; k < done.results.size(); k++)
    {
        const Scan& raw = done.results[k].sweep.scan;
        for (std::size_t i = 0; i < raw.points.size(); i++)
        {
            const Pose pose = brisk.recording.truth(raw.timeOf(raw.points[i])).T_world_imu;
            const Vector3d truth = pose * Vector3d(raw.points[i].position.cast<double>());
            filtered += (done.results[k].points[i] - truth).squaredNorm();
            refined += (done.refined[k].points[i] - truth).squaredNorm();
            n++;
        }
    }
    ASSERT_GT(n, 50'000);
    EXPECT_LT(refined, filtered);
    RecordProperty("refined_mm", std::to_string(1e3 * std::sqrt(refined / n)));
    RecordProperty("filtered_mm", std::to_string(1e3 * std::sqrt(filtered / n)));
}

TEST(Pipeline, ASweepUndistortedAgainAlongItsOwnPathIsTheSame)
{
    const Outcome done = run(hand());
    const ScanResult& r = done.results[30];
    const std::vector<Vector3d> again = r.sweep.undistorted(r.sweep.begin, r.sweep.end);
    ASSERT_EQ(again.size(), r.points.size());
    for (std::size_t i = 0; i < again.size(); i++) ASSERT_LT((again[i] - r.points[i]).norm(), 1e-9);
}

TEST(Pipeline, TwoFromOneConfigurationShareNothing)
{
    registerAll();
    ConfigSection root;
    const OdometryConfig config = OdometryConfig::read(root);
    Executor executor(1);
    std::vector<Vector3d> path[3];
    const auto into = [&](std::vector<Vector3d>& positions) -> EventSink
    {
        return [&positions](const Event& event)
        {
            if (const auto* e = std::get_if<Estimated>(&event))
                positions.push_back(e->result.estimate.state.T_world_imu.p);
        };
    };
    const auto feed = [&](const Streams& streams, std::vector<Pipeline*> pipelines)
    {
        auto sample = streams.imu.begin();
        for (std::size_t k = 0; k < 25; k++)
        {
            for (; sample->t <= streams.scans[k].end; ++sample)
                for (Pipeline* p : pipelines) p->add(*sample);
            for (Pipeline* p : pipelines) p->add(streams.scans[k]);
        }
        for (Pipeline* p : pipelines) p->finish();
    };
    Pipeline alone(config, executor, {}, into(path[0]));
    feed(hand(), {&alone});
    Pipeline one(config, executor, {}, into(path[1])), other(config, executor, {}, into(path[2]));
    feed(hand(), {&one, &other});
    ASSERT_GT(path[0].size(), 20u);
    EXPECT_EQ(path[0], path[1]);
    EXPECT_EQ(path[0], path[2]);
}

TEST(Pipeline, WithoutAnImuTheMotionIsTakenAsConstantVelocity)
{
    // As brisk as with an IMU: up to 2.5 m/s and 1.8 rad/s.
    const Recording& slow = hand().recording;
    const Streams blind{slow, {}, hand().scans};
    const Outcome done = run(blind);
    EXPECT_FALSE(done.with_imu);
    EXPECT_EQ(done.log.count("no_imu"), 1u);
    EXPECT_EQ(done.results.size(), blind.scans.size());
    const auto relative = [&](std::size_t i) -> Pose
    {
        // Its world is level at the start by definition: compared from the first scan on.
        const NavState &first = done.results.front().estimate.state,
                       &x = done.results[i].estimate.state;
        const Pose truth = slow.truth(first.t).T_world_imu.inverse() * slow.truth(x.t).T_world_imu;
        return truth.inverse() * (first.T_world_imu.inverse() * x.T_world_imu);
    };
    for (std::size_t i = 0; i < done.results.size(); i++) EXPECT_LT(relative(i).p.norm(), 0.03);
}

TEST(Pipeline, AnImuThatComesTooLateIsIgnored)
{
    Recording slow;
    slow.swing = 0.3;
    Streams blind{slow, {}, slow.scans()};
    blind.scans.resize(20);
    Streams late = blind;
    late.imu = slow.imu();
    late.imu.erase(late.imu.begin(), late.imu.begin() + 300);  // 1.5 s, half a second too late
    const Outcome with = run(late), without = run(blind);
    EXPECT_GT(with.log.count("late_imu"), 0u);
    EXPECT_FALSE(with.with_imu);
    expectEqual(with, without);
}

TEST(Pipeline, ScansOutOfOrderAreSkippedWithAWarning)
{
    Streams twisted = hand();
    twisted.scans.resize(28);
    const Outcome clean = run(twisted);
    twisted.scans.insert(twisted.scans.begin() + 25, twisted.scans[24]);
    twisted.scans.insert(twisted.scans.begin() + 26, twisted.scans[20]);
    const Outcome done = run(twisted);
    EXPECT_EQ(done.log.count("scan_order"), 2u);
    expectEqual(done, clean);
}

TEST(Pipeline, AGapBetweenScansIsReportedAndSurvived)
{
    Streams gap = hand();
    gap.scans.erase(gap.scans.begin() + 22, gap.scans.begin() + 29);
    const Outcome done = run(gap);
    EXPECT_EQ(done.log.count("lidar_gap"), 1u);
    EXPECT_LT(done.error(gap.recording), 0.02);
}

TEST(Pipeline, IsFoundAgainAfterAGapOfBothSensors)
{
    Streams gap = hand();
    const Time begin = gap.recording.start + fromSeconds(3.0);
    const Time end = begin + fromSeconds(0.8);
    gap.imu.erase(
        std::remove_if(
            gap.imu.begin(), gap.imu.end(),
            [&](const ImuSample& s) { return s.t > begin && s.t < end; }),
        gap.imu.end());
    gap.scans.erase(
        std::remove_if(
            gap.scans.begin(), gap.scans.end(),
            [&](const Scan& s) { return s.end > begin && s.stamp < end; }),
        gap.scans.end());
    const Outcome done = run(gap);
    EXPECT_EQ(done.log.count("lidar_gap"), 1u);
    EXPECT_EQ(done.log.count("pose_doubtful"), 0u);
    EXPECT_LT(done.error(gap.recording), 0.03);
    expectEqual(done, run(gap, "{}", 2));
}

TEST(Pipeline, IsFoundAgainAfterTheClocksJumpForward)
{
    const Time when = hand().recording.start + fromSeconds(3.0);
    for (const double seconds : {2.5, 60.0, 3600.0})
    {
        Streams jump = hand();
        const Duration by = fromSeconds(seconds);
        for (ImuSample& s : jump.imu)
            if (s.t > when) s.t += by;
        for (Scan& s : jump.scans)
            if (s.end > when)
            {
                s.stamp += by;
                s.end += by;
            }
        Outcome done = run(jump);
        EXPECT_EQ(done.log.count("pose_doubtful"), 0u) << seconds;
        for (ScanResult& r : done.results)
            if (r.estimate.state.t > when) r.estimate.state.t -= by;
        EXPECT_LT(done.error(jump.recording), 0.03) << seconds;
    }
}

TEST(Pipeline, APoseThatIsLostIsReported)
{
    Streams turned = hand();
    for (std::size_t i = 35; i < turned.scans.size(); i++)
        for (LidarPoint& p : turned.scans[i].points)
            p.position = {p.position.y(), -p.position.x(), p.position.z()};
    EXPECT_GT(run(turned).log.count("pose_doubtful"), 0u);
    EXPECT_EQ(run(hand()).log.count("pose_doubtful"), 0u);
}

TEST(Pipeline, AScanThatSeesNothingFollowsTheImu)
{
    Streams dark = hand();
    dark.scans.resize(35);
    dark.scans[25].points.clear();
    for (LidarPoint& p : dark.scans[27].points)
        p.position.setConstant(std::numeric_limits<float>::quiet_NaN());
    const Outcome done = run(dark);
    EXPECT_EQ(done.results.size(), dark.scans.size());
    EXPECT_EQ(done.log.count("few_correspondences"), 2u);
    EXPECT_FALSE(done.results[25].report.lidar_used);
    EXPECT_FALSE(done.results[27].report.lidar_used);
    EXPECT_TRUE(done.results[28].report.lidar_used);
    EXPECT_LT(done.error(dark.recording), 0.01);
}

TEST(Pipeline, AlreadyUndistortedScansAreNotUndistortedAgain)
{
    Streams flat = hand();
    flat.scans.resize(40);
    for (Scan& scan : flat.scans)
    {
        const auto sensorAt = [&](Time t)
        { return flat.recording.pose(toSeconds(t - flat.recording.start)) * scan.T_imu_lidar; };
        const Pose T_end_world = sensorAt(scan.end).inverse();
        for (LidarPoint& p : scan.points)
        {
            const Pose T_end_point = T_end_world * sensorAt(scan.timeOf(p));
            p.position = (T_end_point * Vector3d(p.position.cast<double>())).cast<float>();
        }
        scan.already_undistorted = true;
    }
    const double flagged = run(flat).error(flat.recording);
    EXPECT_LT(flagged, 0.006);
    for (Scan& scan : flat.scans) scan.already_undistorted = false;
    EXPECT_GT(run(flat).error(flat.recording), 2 * flagged);
}

TEST(Pipeline, AStartInMotionIsReportedAndSurvived)
{
    const Streams moving = handInMotion();
    const Outcome done = run(moving);
    EXPECT_FALSE(done.initialization->at_rest);
    EXPECT_EQ(done.log.count("no_rest"), 1u);
    EXPECT_EQ(done.log.count("start_unsettled"), 0u);
    EXPECT_GE(done.results.size(), moving.scans.size() - 1);
    for (const ScanResult& r : done.results)
        EXPECT_TRUE(r.estimate.state.T_world_imu.p.allFinite());
    // Moves as the truth does, whatever its world: by the distance of both ends of the motion.
    const NavState &a = done.results.front().estimate.state,
                   &b = done.results.back().estimate.state;
    const double moved = (b.T_world_imu.p - a.T_world_imu.p).norm();
    const double truth =
        (moving.recording.truth(b.t).T_world_imu.p - moving.recording.truth(a.t).T_world_imu.p)
            .norm();
    EXPECT_NEAR(moved, truth, 0.1);
    EXPECT_EQ(done.log.count("pose_doubtful"), 0u);
}

TEST(Pipeline, SteadyMotionThatTheImuTakesForARestIsFoundByTheLidar)
{
    Recording drifting;
    drifting.drift = {0.2, 0.1, 0};
    const Outcome done = run({drifting, drifting.imu(), drifting.scans()});
    EXPECT_TRUE(done.initialization->at_rest) << "the IMU cannot know";
    EXPECT_EQ(done.log.count("rest_left"), 1u);
    const NavState& last = done.results.back().estimate.state;
    EXPECT_LT((last.v_world - drifting.truth(last.t).v_world).norm(), 0.1);
    EXPECT_LT(done.error(drifting), 0.1);
    EXPECT_EQ(run(hand()).log.count("rest_left"), 0u);
}

TEST(Pipeline, ASteadyTurnThatTheImuTakesForARestIsFoundByTheLidar)
{
    Recording turning;
    turning.spin = 0.05;
    const Outcome done = run({turning, turning.imu(), turning.scans()});
    EXPECT_TRUE(done.initialization->at_rest) << "the IMU cannot know";
    EXPECT_EQ(done.log.count("rest_left"), 1u);
    EXPECT_LT(done.error(turning), 0.1);
}

TEST(Pipeline, ABodyThatRestsInFrontOfOneWallDoesNotSlipAlongIt)
{
    // What such a view seems to say of motion along the wall is noise.
    Streams at_wall = hand();
    at_wall.scans.erase(at_wall.scans.begin() + 12, at_wall.scans.end());
    for (Scan& scan : at_wall.scans)
    {
        const Pose T = at_wall.recording.pose(0) * scan.T_imu_lidar;
        const auto elsewhere = [&](const LidarPoint& p)
        { return (T * Vector3d(p.position.cast<double>())).y() < 4.9; };
        scan.points.erase(
            std::remove_if(scan.points.begin(), scan.points.end(), elsewhere), scan.points.end());
        ASSERT_GT(scan.points.size(), 300u);
    }
    const Outcome done = run(at_wall);
    EXPECT_EQ(done.log.count("rest_left"), 0u);
    ASSERT_EQ(done.results.size(), at_wall.scans.size());
    const Pose begin = done.initialization->estimate.state.T_world_imu;
    for (const ScanResult& r : done.results)
    {
        const Pose& pose = r.estimate.state.T_world_imu;
        EXPECT_LT(pose.p.norm(), 0.003);
        EXPECT_LT(logSO3(begin.R.transpose() * pose.R).norm(), 0.002);
    }
}

TEST(Pipeline, ABodyThatTurnsInPlaceOverAFloorDoesNotSlip)
{
    // Nothing but a poor IMU tells of motion along the floor.
    Recording turning;
    turning.swing = 0;
    turning.turn = {0.08, 0.02, 0};
    turning.duration = 8;
    turning.accel_noise = 0.03;
    Streams over_floor{turning, turning.imu(), turning.scans()};
    const Pose T = turning.T_imu_lidar;
    for (Scan& scan : over_floor.scans)
    {
        const auto elsewhere = [&](const LidarPoint& p)
        {
            const double s = toSeconds(scan.timeOf(p) - turning.start);
            return (turning.pose(s) * (T * Vector3d(p.position.cast<double>()))).z() > -1.2;
        };
        scan.points.erase(
            std::remove_if(scan.points.begin(), scan.points.end(), elsewhere), scan.points.end());
        ASSERT_GT(scan.points.size(), 300u);
    }
    const Outcome done = run(over_floor);
    ASSERT_TRUE(done.initialization->at_rest);
    for (const ScanResult& r : done.results)
        EXPECT_LT(r.estimate.state.T_world_imu.p.norm(), 0.1);  // metres, if it is not held
}

TEST(Pipeline, AStartInMotionThatSeesNothingFollowsTheImu)
{
    Streams blind = handInMotion();
    for (Scan& scan : blind.scans) scan.points.resize(5);
    const Outcome done = run(blind);
    EXPECT_GE(done.results.size(), blind.scans.size() - 1);
    for (const ScanResult& r : done.results)
    {
        EXPECT_FALSE(r.report.lidar_used);
        EXPECT_TRUE(r.estimate.state.T_world_imu.p.allFinite());
    }
}

TEST(Pipeline, AStartInMotionThatDoesNotSettleIsReported)
{
    // The IMU turns and falls otherwise than the LiDAR moves.
    Streams torn = handInMotion();
    for (ImuSample& s : torn.imu)
        s.accel += 20 * std::sin(5 * toSeconds(s.t - torn.imu.front().t)) * Vector3d(1, 1, 0);
    EXPECT_EQ(run(torn).log.count("start_unsettled"), 1u);
}

TEST(Pipeline, MemoryDoesNotGrowInARoomThatIsKnown)
{
    Streams early = hand();
    early.scans.resize(40);
    const std::size_t before = run(early).map_size;
    EXPECT_GT(before, 0u);
    EXPECT_LT(run(hand()).map_size, before + before / 2);
}

TEST(Pipeline, HasNothingToSayOfAnEmptyRecording)
{
    const Outcome nothing = run({});
    EXPECT_TRUE(nothing.results.empty());
    Streams no_scans = hand();
    no_scans.scans.clear();
    EXPECT_TRUE(run(no_scans).results.empty());
}

TEST(Pipeline, UsesAShareOfEachScanWhereItIsToldTo)
{
    const Outcome all = run(hand()), half = run(hand(), "{}", 1, false, "start", 0.5);
    ASSERT_EQ(half.results.size(), all.results.size());
    ASSERT_GT(all.results[0].report.features, 500);
    EXPECT_NEAR(half.results[0].report.features, 0.5 * all.results[0].report.features, 1);
    EXPECT_NEAR(
        static_cast<double>(half.results[0].points.size()),
        0.5 * static_cast<double>(all.results[0].points.size()), 2);
    EXPECT_LT(half.error(hand().recording), 0.02);
    // So few are left that fewer would not do.
    EXPECT_GE(run(hand(), "{}", 1, false, "start", 0.001).results[0].report.features, 200);
}
