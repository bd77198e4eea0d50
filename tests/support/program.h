#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace taut::test
{
/** How a program ended and what it said. */
struct ProgramRun
{
    int exit_code = -1;
    std::string output;  //!< of both streams
};

/** Runs a program to its end, through the shell. */
inline ProgramRun runProgram(const std::string& program, const std::string& arguments)
{
    ProgramRun run;
    FILE* pipe = popen((program + " " + arguments + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return run;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        run.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
    return run;
}
}  // namespace taut::test
