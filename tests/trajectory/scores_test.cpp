#include "taut/trajectory/Scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_folder.h"
#include "motions.h"
#include "numeric.h"
#include "taut/trajectory/Interpolation.h"
#include "taut/trajectory/TrajectoryFile.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
/** n poses on a circle of radius r in the horizontal plane, at 10 Hz, once around. */
Trajectory circle(int n, double r)
{
    Trajectory out;
    for (int i = 0; i < n; i++)
    {
        const double a = 2 * M_PI * i / n;
        out.push_back(
            {test::kStart + i * 100'000'000LL,
             {expSO3({0, 0, a}), {r * std::cos(a), r * std::sin(a), 0}}});
    }
    return out;
}

std::string refusalOf(
    const Trajectory& truth, const Trajectory& estimate, const ScoreOptions& options = {})
{
    try
    {
        scoreTrajectory(truth, estimate, options);
    }
    catch (const ScoreRefused& e)
    {
        return e.what();
    }
    return "not refused";
}
}  // namespace

TEST(Interpolation, IsLinearInPositionAndOfConstantRate)
{
    const Pose a{expSO3({0.3, 0, 0}), {1, 2, 3}};
    const Pose b{a.R * expSO3({0, 0, 1}), {3, 2, 1}};
    const Trajectory trajectory{{1000, a}, {2000, b}};
    const auto middle = TrajectoryInterpolator(trajectory).at(1250);
    ASSERT_TRUE(middle);
    EXPECT_LT((middle->p - Vector3d(1.5, 2, 2.5)).norm(), 1e-12);
    EXPECT_LT((middle->R - a.R * expSO3({0, 0, 0.25})).norm(), 1e-12);
}

TEST(Interpolation, NeverAnswersOutsideNorInAGap)
{
    const Trajectory trajectory{{100, {}}, {200, {}}, {300, {}}, {600, {}}, {901, {}}};
    const TrajectoryInterpolator at(trajectory);
    EXPECT_EQ(at.maxGap(), 3 * 300);
    const TrajectoryInterpolator strict(trajectory, 300);
    EXPECT_FALSE(strict.at(99));
    EXPECT_TRUE(strict.at(100));
    EXPECT_TRUE(strict.at(450));   // a spacing as long as the limit is none
    EXPECT_FALSE(strict.at(700));  // one longer by 1 ns is
    EXPECT_TRUE(strict.at(901));   // but its ends are known
    EXPECT_FALSE(strict.at(902));
}

TEST(Interpolation, RefusesTimeThatDoesNotIncrease)
{
    const Trajectory twice{{100, {}}, {100, {}}};
    EXPECT_THROW(TrajectoryInterpolator{twice}, std::invalid_argument);
}

TEST(AbsoluteError, IsZeroForTheSameMotionSeenFromAnotherWorld)
{
    const Trajectory truth = test::lissajous(60, 200);
    const Pose T{expSO3({0.4, -1.2, 2.8}), {100, -50, 7}};
    const Scores scores = scoreTrajectory(truth, test::moved(T, truth));
    EXPECT_LT(scores.absolute.position.max, 1e-11);
    EXPECT_LT(scores.absolute.rotation_deg.max, 1e-10);
    EXPECT_LT((scores.absolute.T_truth_estimate.R - T.inverse().R).norm(), 1e-12);
    EXPECT_NEAR(scores.coverage.share, 1, 1e-12);
    EXPECT_NEAR(scores.truth_path, scores.estimate_path, 1e-9);
}

TEST(AbsoluteError, WithYawAlignmentKeepsATilt)
{
    const Trajectory truth = test::lissajous(60, 10);
    ScoreOptions options;
    options.alignment = Alignment::Yaw;
    const Pose turned{expSO3({0, 0, 2.5}), {4, 5, 6}};
    EXPECT_LT(
        scoreTrajectory(truth, test::moved(turned, truth), options).absolute.position.max, 1e-12);
    const double tilt = 0.1;
    const Pose tilted{expSO3({tilt, 0, 0}), {}};
    const Scores scores = scoreTrajectory(truth, test::moved(tilted, truth), options);
    EXPECT_GE(scores.absolute.rotation_deg.median, tilt * kDegreesPerRadian - 1e-9);
    EXPECT_GT(scores.absolute.position.rmse, 0.1);
}

TEST(AbsoluteError, WithoutAlignmentIsTheOffset)
{
    const Trajectory truth = test::lissajous(60, 10);
    ScoreOptions options;
    options.alignment = Alignment::None;
    const Scores scores =
        scoreTrajectory(truth, test::moved({Matrix3d::Identity(), {0, 3, 4}}, truth), options);
    for (const double v :
         {scores.absolute.position.rmse, scores.absolute.position.mean,
          scores.absolute.position.median, scores.absolute.position.max})
        EXPECT_NEAR(v, 5, 1e-12);
    EXPECT_LT(scores.absolute.rotation_deg.max, 1e-6);
}

TEST(AbsoluteError, OfAScaleErrorOnACircleIsTheScaleTimesTheRadius)
{
    const Trajectory truth = circle(100, 10);
    Trajectory estimate = truth;
    for (auto& pose : estimate) pose.T_world_imu.p *= 1.02;
    const Scores scores = scoreTrajectory(truth, estimate);
    EXPECT_NEAR(scores.absolute.position.rmse, 0.2, 1e-12);  // the alignment has no scale
    EXPECT_NEAR(scores.absolute.position.max, 0.2, 1e-12);
}

TEST(AbsoluteError, OfAnAlternatingOffsetIsTheOffset)
{
    // +d, -d in turn along z: the mean is zero, and on an even circle nothing leans, so the
    // alignment has nothing to take away.
    const Trajectory truth = circle(100, 10);
    Trajectory estimate = truth;
    for (std::size_t i = 0; i < estimate.size(); i++)
        estimate[i].T_world_imu.p.z() += i % 2 == 0 ? 0.05 : -0.05;
    EXPECT_NEAR(scoreTrajectory(truth, estimate).absolute.position.rmse, 0.05, 1e-6);
}

TEST(AbsoluteError, OfWhiteNoiseIsItsSigma)
{
    const int n = 5000;
    const double sigma = 0.02;
    const Trajectory truth = circle(n, 10);
    Trajectory estimate = truth;
    test::Random random(7);
    for (auto& pose : estimate)
    {
        pose.T_world_imu.p += random.vector(sigma);
        pose.T_world_imu.R = pose.T_world_imu.R * expSO3(random.vector(0.01));
    }
    const Scores scores = scoreTrajectory(truth, estimate);
    // 3n values less the six that the alignment takes; the RMSE spreads by 1/sqrt(2 * 3n).
    const double expected = sigma * std::sqrt(3.0 - 6.0 / n);
    EXPECT_NEAR(scores.absolute.position.rmse, expected, 4 * expected / std::sqrt(6.0 * n));
    EXPECT_NEAR(scores.absolute.rotation_deg.rmse, 0.01 * std::sqrt(3.0) * kDegreesPerRadian, 0.03);
}

TEST(AbsoluteError, SaysWhenThePositionsDoNotDetermineTheAlignment)
{
    Trajectory line, rest;
    for (int i = 0; i < 20; i++)
    {
        line.push_back({i * 100, {Matrix3d::Identity(), {0, 0, 0.1 * i}}});
        rest.push_back({i * 100, {}});
    }
    EXPECT_THROW(scoreTrajectory(line, line), std::runtime_error);
    ScoreOptions options;
    options.alignment = Alignment::Yaw;
    EXPECT_THROW(scoreTrajectory(rest, rest, options), std::runtime_error);
    options.alignment = Alignment::None;
    EXPECT_EQ(scoreTrajectory(rest, rest, options).absolute.position.max, 0);
}

TEST(Scores, InterpolateADenseTruthToASparseEstimate)
{
    const Trajectory truth = test::lissajous(60, 200), all = test::lissajous(60, 1000);
    Trajectory estimate;  // 10 Hz, between the stamps of the truth
    for (std::size_t i = 2; i < all.size(); i += 100) estimate.push_back(all[i]);
    const Scores scores = scoreTrajectory(truth, estimate);
    EXPECT_EQ(scores.pairs.size(), estimate.size());
    // Linear interpolation is off by at most a dt^2 / 8, with a < 1.5 m/s^2 and 2 rad/s^2 here.
    EXPECT_LT(scores.absolute.position.max, 1.5 * 0.005 * 0.005 / 8);
    EXPECT_LT(scores.absolute.rotation_deg.max, 2 * 0.005 * 0.005 / 8 * kDegreesPerRadian);
    EXPECT_GT(scores.absolute.position.max, 1e-7);
}

TEST(Scores, InterpolateTheDenserOfBoth)
{
    const Trajectory sparse = test::lissajous(20, 1), dense = test::lissajous(20, 10);
    EXPECT_FALSE(scoreTrajectory(dense, sparse).at_truth_poses);
    EXPECT_FALSE(scoreTrajectory(dense, dense).at_truth_poses);
    const Scores exact = scoreTrajectory(sparse, dense);
    EXPECT_TRUE(exact.at_truth_poses);
    EXPECT_EQ(exact.pairs.size(), sparse.size());
    EXPECT_LT(exact.absolute.position.max, 1e-9);

    Trajectory between = dense;  // stamps of the truth lie between those of the estimate
    for (StampedPose& pose : between) pose.t += 30'000'000;
    ScoreOptions options;
    options.alignment = Alignment::None;
    const Scores moved = scoreTrajectory(sparse, between, options);
    EXPECT_EQ(moved.pairs.size(), sparse.size() - 1);
    EXPECT_LT(moved.absolute.position.max, 0.1);  // 30 ms at 2.5 m/s, not half of a second

    Trajectory gap = dense;  // of a second: neither side says anything there
    gap.erase(gap.begin() + 95, gap.begin() + 105);
    EXPECT_EQ(scoreTrajectory(sparse, gap).pairs.size(), sparse.size() - 1);
}

TEST(Scores, OfARealTruthAgainstASubsampledCopyAreZero)
{
    const auto path = test::dataFolder() / "hall_violent.gt.tum";
    if (!std::filesystem::exists(path)) return test::skipWithout("hall_violent.gt.tum");
    const Trajectory truth = readTum(path.string());
    Trajectory estimate;
    for (std::size_t i = 7; i < truth.size(); i += 20) estimate.push_back(truth[i]);
    const Scores scores = scoreTrajectory(truth, estimate);
    EXPECT_EQ(scores.pairs.size(), estimate.size());
    EXPECT_LT(scores.absolute.position.max, 1e-12);
    EXPECT_LT(scores.absolute.rotation_deg.max, 1e-12);
    EXPECT_NEAR(scores.truth_path, 45.3, 0.1);
    for (const RelativeError& e : scores.over_time) EXPECT_LT(e.translation.max, 1e-12);
    EXPECT_LT(scores.short_segments.all.translation_percent, 1e-12);
}

TEST(Scores, LeaveOutPosesInAGapOfTheTruth)
{
    Trajectory truth = test::lissajous(20, 100);
    const Trajectory estimate = test::lissajous(20, 10);
    const auto second = [](const StampedPose& pose) { return toSeconds(pose.t - test::kStart); };
    truth.erase(
        std::remove_if(
            truth.begin(), truth.end(),
            [&](const StampedPose& pose) { return second(pose) > 5.005 && second(pose) < 6.995; }),
        truth.end());
    EXPECT_EQ(scoreTrajectory(truth, estimate).pairs.size(), estimate.size() - 19);
}

TEST(Coverage, LeavesOutGapsAndTellsThem)
{
    const Trajectory truth = test::lissajous(20, 100);
    Trajectory estimate;
    for (const StampedPose& pose : test::lissajous(20, 10))
    {
        const double s = toSeconds(pose.t - test::kStart);
        if ((s > 1.95 && s < 10.05) || (s > 12.95 && s < 19.05)) estimate.push_back(pose);
    }
    const Coverage c = coverageOf(truth, estimate);
    EXPECT_NEAR(c.truth_span, 20, 1e-9);
    EXPECT_NEAR(c.share, (8 + 6) / 20.0, 1e-9);
    EXPECT_NEAR(c.late_start, 2, 1e-9);
    EXPECT_NEAR(c.early_end, 1, 1e-9);
    EXPECT_NEAR(c.largest_gap, 3, 1e-9);
}

TEST(Coverage, TooLittleIsRefused)
{
    const Trajectory truth = test::lissajous(20, 100);
    Trajectory estimate = test::lissajous(9, 10);
    EXPECT_THAT(
        refusalOf(truth, estimate), HasSubstr("covers 45.0 % of the truth's 20.000 s, 50.0 %"));
    ScoreOptions options;
    options.min_coverage = 0.4;
    EXPECT_EQ(refusalOf(truth, estimate, options), "not refused");
    EXPECT_EQ(refusalOf(truth, test::lissajous(11, 10)), "not refused");
}

TEST(Coverage, TooFewPosesAreRefused)
{
    const Trajectory truth = test::lissajous(20, 100);
    EXPECT_THAT(
        refusalOf(truth, test::lissajous(16, 0.5)), HasSubstr("only 9 of the estimate's 9"));
    EXPECT_THAT(refusalOf(truth, {}), HasSubstr("only 0 of the estimate's 0"));
    EXPECT_THAT(refusalOf({}, truth), HasSubstr("only 0 of the estimate's 2001"));
    EXPECT_EQ(refusalOf(truth, test::lissajous(18, 0.5)), "not refused");
}

TEST(Coverage, AnEstimateOfAnotherClockIsRefused)
{
    const Trajectory truth = test::lissajous(20, 100);
    Trajectory estimate = truth;
    for (auto& pose : estimate) pose.t -= test::kStart;
    EXPECT_THAT(refusalOf(truth, estimate), HasSubstr("have a truth at their time"));
}
