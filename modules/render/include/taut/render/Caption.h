#pragma once

#include <string>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** Facts about a run, for the caption of its pictures. */
struct RunFacts
{
    std::string sequence;
    double length = 0;      //!< of the trajectory [m]
    Duration duration = 0;  //!< of the trajectory
    std::string mode;       //!< of the undistortion; may be unknown
};

/** Two lines: the sequence; length, duration and mode. */
std::vector<std::string> captionOf(const RunFacts& run);
}  // namespace taut
