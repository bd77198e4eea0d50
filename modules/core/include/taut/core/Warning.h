#pragma once

#include <functional>
#include <string>

#include "taut/core/Time.h"

namespace taut
{
/** Something in the data or the estimation that the user should know: when, and what. */
struct Warning
{
    Time t = 0;        //!< time of the data concerned; 0 if none
    std::string kind;  //!< short and stable, for counting: "imu_gap"
    std::string text;  //!< the cause, with values and units
};

/** Where libraries leave warnings: they never log. May be empty. */
using WarningSink = std::function<void(const Warning&)>;
}  // namespace taut
