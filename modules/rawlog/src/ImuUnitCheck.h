#pragma once

#include <optional>
#include <string>

#include "taut/core/ImuUnits.h"

namespace taut
{
/** Looks whether the values of an IMU can be in m/s^2 and rad/s, and says the line of the rig file
 * that mends it. The values themselves are never changed. */
class ImuUnitCheck
{
 public:
    /** What is wrong, at most once for each cause; samples in the order of time. */
    std::optional<std::string> add(const ImuSample& sample);

 private:
    std::optional<std::string> judgeForce() const;

    ImuUnitJudge judge_;
    std::optional<Time> first_;
    bool first_second_over_ = false, rate_reported_ = false;
};
}  // namespace taut
