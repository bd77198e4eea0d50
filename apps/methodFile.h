#pragma once

#include <string>
#include <vector>

#include "taut/core/Config.h"

namespace taut
{
/** Path of a method file: as given, or config/default.yaml of the installation or the source tree.
 * Throws std::runtime_error if there is none. */
std::string findMethodFile(const std::string& given);

/** The file with the settings "section.key=value" laid over it. A setting of `type` to another
 * class than the file's drops what the file gives for that one. Throws ConfigError. */
ConfigSection readMethodFile(const std::string& path, const std::vector<std::string>& settings);
}  // namespace taut
