#pragma once

#include <algorithm>
#include <cmath>

namespace taut
{
/** Tells intensities from 0 to 1, of which a rawlog, which holds whole numbers up to 255, would
 * keep nothing. */
class IntensityRange
{
 public:
    void add(float intensity)
    {
        if (!std::isfinite(intensity)) return;
        largest_ = std::max(largest_, intensity);
        has_fractions_ |= intensity > 0 && intensity < 1;
    }

    /** To 0 to 255. */
    double scale() const { return has_fractions_ && largest_ <= 1 ? 255 : 1; }

 private:
    float largest_ = 0;
    bool has_fractions_ = false;
};

inline constexpr const char* kIntensityScaled = "intensity: from 0 to 1, times 255";
}  // namespace taut
