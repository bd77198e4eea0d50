#pragma once

#include <string>
#include <vector>

#include "taut/core/LoopClosure.h"

namespace taut
{
/** All candidates with their evidence and verdicts as a table (CSV, one a line). Throws
 * std::runtime_error if it cannot be written. */
void writeLoops(const std::string& path, const std::vector<LoopClosure>& loops);
}  // namespace taut
