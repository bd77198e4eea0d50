#include "taut/factors/SampledPath.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "taut/factors/ImuFactor.h"
#include "taut/preintegration/MidpointPreintegrator.h"

using namespace taut;

namespace
{
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kEnd = 100 * kMillisecond;

/** A sweep of a body that is shaken: the rate swings to 8 rad/s, by up to 75 rad/s^2. */
PreintegratedImu shaken(Duration period)
{
    ImuSamples samples;
    for (Time t = -period; t <= kEnd + period; t += period)
    {
        const double phase = 9.4 * toSeconds(t);
        samples.push_back(
            {t,
             {8 * std::sin(phase), 2 * std::cos(phase), 1},
             {3 * std::cos(phase), 20 * std::sin(phase), 9.81}});
    }
    PreintegrationRequest request;
    request.end = kEnd;
    request.samples = &samples;
    return MidpointPreintegrator().integrate(request);
}
}  // namespace

TEST(SampledPath, IsExactToATenthOfAMillimetreOnAShakenBody)
{
    const PreintegratedImu imu = shaken(5 * kMillisecond);
    const NavState previous;
    const SweepPath path(Undistortion::Bridge, imu, previous, predict(imu, previous));
    const SampledPath sampled(path, 0, kEnd);
    double worst = 0, sum = 0;
    int count = 0;
    std::size_t hint = 0;
    for (Time t = 0; t <= kEnd; t += 33'333)
        for (const Vector3d& point : {Vector3d(20, 0, 0), Vector3d(0, 20, 0), Vector3d(0, 0, 20)})
        {
            const double error = (sampled.poseAt(t) * point - path.poseAt(t, hint) * point).norm();
            worst = std::max(worst, error);
            sum += error;
            count++;
        }
    EXPECT_LT(worst, 1e-4);
    EXPECT_LT(sum / count, 1e-5);
    EXPECT_GT(worst, 0);  // it is sampled
}

TEST(SampledPath, OfASingleTimeIsThePathThere)
{
    const PreintegratedImu imu = shaken(5 * kMillisecond);
    const NavState previous;
    const SweepPath path(Undistortion::Bridge, imu, previous, predict(imu, previous));
    std::size_t hint = 0;
    const Pose exact = path.poseAt(kEnd, hint),
               sampled = SampledPath(path, kEnd, kEnd).poseAt(kEnd);
    EXPECT_LT((exact.p - sampled.p).norm(), 1e-12);
    EXPECT_LT((exact.R - sampled.R).norm(), 1e-12);
}
