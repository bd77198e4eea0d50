# cmake -D FOLDER=FOLDER -D WRITE_COMMIT=write-commit.cmake -P commit.cmake: the commit that a build is told, of sources
# in a repository, changed, without a repository, and in a folder of somebody else's.
cmake_minimum_required(VERSION 3.25)
set(source ${FOLDER}/source)
set(file ${FOLDER}/Commit.cpp)

function(expect commit sources)
  execute_process(COMMAND ${CMAKE_COMMAND} -D SOURCE=${sources} -D OUTPUT=${file} -P ${WRITE_COMMIT}
                  COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${file} text)
  if(NOT text MATCHES "kCommit = \"${commit}\";")
    message(FATAL_ERROR "expected the commit '${commit}' in\n${text}")
  endif()
endfunction()

function(git)
  execute_process(
    COMMAND ${GIT} -C ${source} -c user.name=Test -c user.email=test@example.org ${ARGV}
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(git_output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${source}/part)
expect(unknown ${source}) # which may be a folder in the repository of taut
find_program(GIT git)
if(NOT GIT)
  message(STATUS "no git here: the rest is not tested")
  return()
endif()
git(init --quiet)
file(WRITE ${source}/file "one\n")
git(add file)
git(commit --quiet --message=One)
git(tag v9)
git(rev-parse --short=10 HEAD)
expect(${git_output} ${source})
expect(unknown ${source}/part)
file(WRITE ${source}/file "other\n")
expect(${git_output}-dirty ${source})

# The second look-up finds the same and leaves the file alone.
file(TIMESTAMP ${file} before "%s" UTC)
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)
expect(${git_output}-dirty ${source})
file(TIMESTAMP ${file} after "%s" UTC)
if(NOT before EQUAL after)
  message(FATAL_ERROR "the source was written again though the commit is the same")
endif()
