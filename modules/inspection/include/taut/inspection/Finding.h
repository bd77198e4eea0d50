#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** Something about a recording that whoever wants to run on it should know. */
struct Finding
{
    Time t = 0;             //!< of the worst or the first case; 0: of the whole recording
    std::string kind;       //!< short and stable: "imu_gap"
    double value = 0;       //!< of that case, in `unit`
    std::string unit;       //!< empty: a plain number
    std::size_t count = 1;  //!< cases
    std::string text;       //!< what is so
    std::string advice;     //!< what to do
};
using Findings = std::vector<Finding>;
}  // namespace taut
