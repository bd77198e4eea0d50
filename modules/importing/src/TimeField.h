#pragma once

#include <string>
#include <vector>

namespace taut
{
/** The name of `--time-field` that says: none of them. */
inline constexpr const char* kNoTimeField = "none";

/** Position of the field that holds the times of the points, by its name; -1 if there is none.
 * Names that drivers are known to write go first, in any case of letters and with CloudCompare's
 * "scalar_" before them; then the only one that looks like a time. `asked` is the name that
 * --time-field gave, or empty. Throws std::runtime_error, naming them, where several look like
 * times and none is known, and where what was asked for is not there. */
int timeFieldOf(const std::vector<std::string>& names, const std::string& asked);

/** The unit that the end of a name tells [ns]: "time_offset_us" has 1000; 0 if it tells none. */
double unitOfName(const std::string& name);
}  // namespace taut
