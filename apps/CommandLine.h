#pragma once

#include <mrpt/3rdparty/tclap/CmdLine.h>

#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "taut/core/Yaml.h"

namespace taut
{
/** The program was called wrongly. */
struct UsageError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** Parses the command line. False if that was all there was to do (--help, --version); throws
 * UsageError where MRPT's TCLAP alone would print and return the same false. */
inline bool parseCommandLine(TCLAP::CmdLine& cmd, int argc, char** argv)
{
    struct Output : TCLAP::StdOutput
    {
        void failure(TCLAP::CmdLineInterface& /*cmd*/, TCLAP::ArgException& e) override
        {
            throw UsageError(e.error() + " " + e.argId());
        }
    } output;
    const std::unique_ptr<TCLAP::CmdLineOutput> replaced(cmd.getOutput());  // TCLAP would leak it
    cmd.setOutput(&output);
    return cmd.parse(argc, argv);
}

/** Calls `body` and gives the exit code: what it returns (0 if nothing), 1 failed, 2 bad usage or a
 * configuration that cannot be used. */
template <class Body>
int runProgram(const std::string& name, Body body)
{
    try
    {
        if constexpr (std::is_void_v<decltype(body())>)
        {
            body();
            return 0;
        }
        else
        {
            return body();
        }
    }
    catch (const UsageError& e)
    {
        std::cerr << name << ": " << e.what() << " (see " << name << " --help)\n";
        return 2;
    }
    catch (const ConfigError& e)
    {
        std::cerr << name << ": " << e.what() << "\n";
        return 2;
    }
    catch (const std::exception& e)
    {
        std::cerr << name << ": " << e.what() << "\n";
        return 1;
    }
}
}  // namespace taut
