#include "taut/factors/SampledPath.h"

#include <algorithm>

namespace taut
{
SampledPath::SampledPath(const SweepPath& path, Time begin, Time end) : begin_(begin)
{
    const auto parabolas =
        static_cast<std::size_t>(std::max<Duration>(0, end - begin) / (2 * kSpacing) + 1);
    poses_.resize(2 * parabolas + 1);
    std::size_t hint = 0;
    for (std::size_t i = poses_.size(); i-- > 0;)  // as the chain is stored: backward in time
        poses_[i] = path.poseAt(begin + static_cast<Duration>(i) * kSpacing, hint);
}

Pose SampledPath::poseAt(Time t) const
{
    const auto last = static_cast<Duration>(poses_.size()) / 2 - 1;
    const Duration parabola = std::clamp<Duration>((t - begin_) / (2 * kSpacing), 0, last);
    const Pose* pose = &poses_[static_cast<std::size_t>(2 * parabola)];
    // Of its middle, in spacings: -1 to 1.
    const double u = static_cast<double>(t - begin_ - (2 * parabola + 1) * kSpacing) /
                     static_cast<double>(kSpacing);
    const double before = 0.5 * u * (u - 1), after = 0.5 * u * (u + 1), middle = 1 - u * u;
    Pose at;
    at.R = before * pose[0].R + middle * pose[1].R + after * pose[2].R;
    at.p = before * pose[0].p + middle * pose[1].p + after * pose[2].p;
    return at;
}
}  // namespace taut
