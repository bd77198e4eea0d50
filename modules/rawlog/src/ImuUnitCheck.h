#pragma once

#include <optional>
#include <string>

#include "taut/core/Imu.h"

namespace taut
{
/** Looks whether the values of an IMU can be in m/s^2 and rad/s: by the mean specific force of the
 * first second, by whether the gyro agrees with how gravity turned in it, and by rates that no IMU
 * reaches. */
class ImuUnitCheck
{
 public:
    /** What is wrong, at most once for each cause; samples in the order of time. */
    std::optional<std::string> add(const ImuSample& sample);

 private:
    std::optional<std::string> judgeFirstSecond() const;

    ImuSamples first_second_;
    bool judged_ = false, rate_reported_ = false;
};
}  // namespace taut
