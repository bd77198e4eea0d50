#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace taut
{
/** A folder holds something that results would overwrite. */
struct FolderInUse : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** Removes what the loops of an earlier run left: nothing of two runs is mixed. */
void removeLoopResults(const std::string& folder);

/** Makes a folder ready for the results of a run: creates it, or, where it holds results of taut
 * and `overwrite` says so, removes these and nothing else. A file `.taut-results` in the folder
 * tells that its results are taut's.
 *
 * Throws FolderInUse if a file that taut did not write has the name of a result, if there are
 * results and `overwrite` is false, if another program is writing to it, and if one of `inputs`
 * (files that the run reads; empty names are none) would be overwritten. Throws std::runtime_error
 * if the folder is a file or cannot be made. Symbolic links are removed, never followed. */
void prepareResultFolder(
    const std::string& folder, bool overwrite, const std::vector<std::string>& inputs);
}  // namespace taut
