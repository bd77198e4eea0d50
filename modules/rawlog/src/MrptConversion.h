#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** MRPT counts 100 ns ticks from the year 1601, taut nanoseconds from 1970. */
inline constexpr std::int64_t kTicksTo1970 = 116444736000000000;
inline constexpr std::int64_t kNanosecondsPerTick = 100;

/** 120 years to each side of 1970, in ticks: differences of such stamps fit into nanoseconds. */
inline constexpr std::int64_t kLargestTicks = 120 * std::int64_t{31'557'600} * 10'000'000;

/** False for INVALID_TIMESTAMP as well. */
inline bool isValidStamp(mrpt::Clock::time_point t)
{
    const auto ticks = t.time_since_epoch().count();
    return ticks >= kTicksTo1970 - kLargestTicks && ticks <= kTicksTo1970 + kLargestTicks;
}

/** What is no valid stamp is taken for the closest one that is. */
inline Time toTime(mrpt::Clock::time_point t)
{
    const auto ticks = std::clamp<std::int64_t>(
        t.time_since_epoch().count(), kTicksTo1970 - kLargestTicks, kTicksTo1970 + kLargestTicks);
    return (ticks - kTicksTo1970) * kNanosecondsPerTick;
}

/** Rounded to MRPT's 100 ns. */
inline mrpt::Clock::time_point toMrptTime(Time t)
{
    const Time rest = t % kNanosecondsPerTick;
    const Time rounding = 2 * rest / kNanosecondsPerTick;  // 1, 0 or -1
    return mrpt::Clock::time_point(
        mrpt::Clock::duration(t / kNanosecondsPerTick + rounding + kTicksTo1970));
}

inline Pose toPose(const mrpt::poses::CPose3D& pose)
{
    return {pose.getRotationMatrix().asEigen(), {pose.x(), pose.y(), pose.z()}};
}

inline mrpt::poses::CPose3D toMrptPose(const Pose& pose)
{
    mrpt::math::CMatrixDouble33 R;
    R.asEigen() = pose.R;
    return mrpt::poses::CPose3D(
        R, mrpt::math::CVectorFixedDouble<3>({pose.p.x(), pose.p.y(), pose.p.z()}));
}
}  // namespace taut
