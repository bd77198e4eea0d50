#pragma once

#include <optional>
#include <string>
#include <vector>

namespace taut
{
/** The first of `files` that is the same file as `path`, also by another name or through links.
 * Empty names and files that are not there are none. */
std::optional<std::string> sameFile(const std::string& path, const std::vector<std::string>& files);
}  // namespace taut
