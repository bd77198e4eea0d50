#pragma once

#include <functional>
#include <string>
#include <vector>

namespace taut
{
/** Throws UsageError if writing `output` would destroy a file that is read (one of `inputs`, also
 * by another name or through links; empty names are none), or one that is there and that `is_own`
 * does not know for a file of taut's. */
void guardOutput(
    const std::string& output, const std::vector<std::string>& inputs,
    const std::function<bool(const std::string&)>& is_own);
}  // namespace taut
