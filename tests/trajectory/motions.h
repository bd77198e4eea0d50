#pragma once

#include <cmath>

#include "taut/trajectory/Trajectory.h"

namespace taut::test
{
inline constexpr Time kStart = 1'700'000'000'123'456'789;

/** A lively motion without symmetry, `seconds` long at `rate` poses a second. */
inline Trajectory lissajous(double seconds, double rate)
{
    Trajectory out;
    const int n = static_cast<int>(std::lround(seconds * rate));
    for (int i = 0; i <= n; i++)
    {
        const double s = i / rate;
        out.push_back(
            {kStart + fromSeconds(s),
             {expSO3({std::sin(s), 0.5 * std::cos(0.7 * s), s}),
              {5 * std::sin(0.3 * s), 3 * std::cos(0.5 * s), std::sin(0.9 * s)}}});
    }
    return out;
}

/** The trajectory seen from another world. */
inline Trajectory moved(const Pose& T, Trajectory trajectory)
{
    for (StampedPose& pose : trajectory) pose.T_world_imu = T * pose.T_world_imu;
    return trajectory;
}
}  // namespace taut::test
