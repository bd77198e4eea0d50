#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** MRPT counts 100 ns ticks from the year 1601, taut nanoseconds from 1970. */
inline constexpr std::int64_t kTicksTo1970 = 116444736000000000;
inline constexpr std::int64_t kNanosecondsPerTick = 100;

inline Time toTime(mrpt::Clock::time_point t)
{
    return (t.time_since_epoch().count() - kTicksTo1970) * kNanosecondsPerTick;
}

/** Rounded to MRPT's 100 ns. */
inline mrpt::Clock::time_point toMrptTime(Time t)
{
    const Time half = t < 0 ? -kNanosecondsPerTick / 2 : kNanosecondsPerTick / 2;
    return mrpt::Clock::time_point(
        mrpt::Clock::duration((t + half) / kNanosecondsPerTick + kTicksTo1970));
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
