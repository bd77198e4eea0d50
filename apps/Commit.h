#pragma once

namespace taut
{
/** The commit of the sources, as "44d6188a1b", with "-dirty" behind it where files that git knows
 * were changed. "unknown" where the sources are not a git repository. Commit.cpp is written by each
 * build (cmake/write-commit.cmake). */
extern const char* const kCommit;
}  // namespace taut
