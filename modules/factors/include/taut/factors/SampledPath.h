#pragma once

#include <vector>

#include "taut/factors/SweepPath.h"

namespace taut
{
/** A path for the thousands of points of a sweep: evaluated exactly every millisecond, a parabola
 * through three such poses between them. On a body that turns with 8 rad/s and 75 rad/s^2 a point
 * 20 m away is less than 0.1 mm off, mostly less than 0.01 mm. */
class SampledPath
{
 public:
    /** For times from `begin` to `end`, both included; others are extrapolated. */
    SampledPath(const SweepPath& path, Time begin, Time end);

    Pose poseAt(Time t) const;

 private:
    static constexpr Duration kSpacing = 1'000'000;  // [ns]

    Time begin_;
    std::vector<Pose> poses_;  // an odd number
};
}  // namespace taut
