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
}  // namespace taut
