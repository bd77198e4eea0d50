# cmake -D SOURCE=FOLDER -D OUTPUT=FILE.cpp -P write-commit.cmake: writes the source that holds the commit. A file that
# would stay the same is not touched, so that nothing is built again.
set(commit "")
find_program(GIT git)
if(GIT)
  # Sources without a repository of their own, as of a tarball, may lie in somebody else's.
  execute_process(
    COMMAND ${GIT} -C ${SOURCE} rev-parse --show-prefix
    OUTPUT_VARIABLE prefix
    RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed AND prefix STREQUAL "")
    execute_process(
      COMMAND ${GIT} --no-optional-locks -C ${SOURCE} describe --always --dirty --abbrev=10 --exclude=*
      OUTPUT_VARIABLE commit
      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
if(NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "Commit.h"

namespace taut
{
const char* const kCommit = "@commit@";
}  // namespace taut
]])
