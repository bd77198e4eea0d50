#pragma once

#include <string>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Warning.h"

namespace taut::bag
{
/** Judges from the first readings whether the specific force is in m/s^2, as the message should
 * have it, or in g or milli-g, as some drivers write it, and converts it. */
class ImuUnits
{
 public:
    /** Readings of a second or more; a warning "imu_units" if they fit no unit. */
    void learn(const ImuSamples& samples, const WarningSink& warn);

    ImuSample toSi(ImuSample sample) const
    {
        sample.accel *= accel_scale_;
        return sample;
    }

    const std::vector<std::string>& findings() const { return findings_; }

 private:
    double accel_scale_ = 1;
    std::vector<std::string> findings_;
};
}  // namespace taut::bag
