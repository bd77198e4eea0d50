#include "Panorama.h"

#include <algorithm>
#include <cmath>

#include "SweepOrder.h"

namespace taut
{
Panorama::Panorama(const Scan& scan) : ranges_(static_cast<std::size_t>(kRows) * kBins, 0)
{
    std::vector<double> counts(ranges_.size(), 0);
    for (const LidarPoint& point : scan.points)
    {
        const Vector3d p = point.position.cast<double>();
        const double range = p.norm();
        if (!(range > 0)) continue;
        double turn = azimuthOf(point) / (2 * M_PI);
        turn -= std::floor(turn);
        const int bin = std::min(kBins - 1, static_cast<int>(turn * kBins));
        const double up = std::asin(std::clamp(p.z() / range, -1.0, 1.0)) / M_PI + 0.5;
        const int row = std::clamp(static_cast<int>(up * kRows), 0, kRows - 1);
        const auto cell = static_cast<std::size_t>(row * kBins + bin);
        ranges_[cell] += range;
        counts[cell]++;
    }
    for (std::size_t i = 0; i < ranges_.size(); i++)
        if (counts[i] > 0) ranges_[i] /= counts[i];
}
}  // namespace taut
