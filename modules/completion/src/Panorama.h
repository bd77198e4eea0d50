#pragma once

#include <vector>

#include "taut/core/Scan.h"

namespace taut
{
/** What a sweep sees, by elevation and azimuth: mean ranges [m], 0 where nothing is. */
class Panorama
{
 public:
    static constexpr int kRows = 180;  //!< of elevation, from below: a degree each
    static constexpr int kBins = 180;  //!< of azimuth, from 0 on: two degrees each

    explicit Panorama(const Scan& scan);

    /** `bin` may be any number of turns away. */
    double range(int row, int bin) const
    {
        const int around = (bin % kBins + kBins) % kBins;
        return ranges_[static_cast<std::size_t>(row * kBins + around)];
    }

 private:
    std::vector<double> ranges_;
};
}  // namespace taut
