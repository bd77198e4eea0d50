#pragma once

#include <string>

#include "taut/inspection/Inspection.h"

namespace taut
{
/** For people: what the recording is like, then each finding with time, value and what to do. Times
 * count from the first stamp of the log. */
std::string inspectionAsText(const Inspection& inspection);

/** For programs: the same; what is not known is null. */
std::string inspectionAsJson(const Inspection& inspection);
}  // namespace taut
