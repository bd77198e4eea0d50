#pragma once

#include <memory>
#include <string>

#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"
#include "taut/importing/ImportSource.h"

namespace taut
{
/** Opens a recording, of whichever format it looks like: by its first bytes, its name or, for a
 * folder, by what is in it. Throws std::runtime_error naming the recording if it is not there, is
 * of no format that is known (the message lists those) or is known to be unusable.
 *
 * Whatever the format, what comes out is in m/s^2 and rad/s (judged by gravity where the options do
 * not tell, and said in the findings), finite, and of each sensor in the order of time. */
std::unique_ptr<ImportSource> openImportSource(
    const std::string& path, const ImportOptions& options = {}, const WarningSink& warn = {});

/** True if there is a file or folder of such a format; a rawlog is none. */
bool canBeImported(const std::string& path);
}  // namespace taut
