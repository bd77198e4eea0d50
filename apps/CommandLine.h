#pragma once

#include <mrpt/3rdparty/tclap/CmdLine.h>

#include <iostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "taut/core/ChoiceNeeded.h"
#include "taut/core/Yaml.h"

namespace taut
{
/** The program was called wrongly. */
struct UsageError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** What a program says of its use besides its options. */
struct Usage
{
    std::vector<std::string> examples;  //!< arguments without the program's name
    /** An option that needs none of the required arguments; null: there is none. */
    const TCLAP::Arg* alone = nullptr;
    /** What the program requires, though TCLAP does not: it may be given in another way. */
    std::vector<const TCLAP::Arg*> required = {};
};

/** Parses the command line. False if that was all there was to do (--help, --version). Throws
 * UsageError that names what is missing or wrong, and the nearest option to one that is unknown. */
bool parseCommandLine(TCLAP::CmdLine& cmd, int argc, char** argv, const Usage& usage = {});

/** The number of threads that --threads asks for: 0 is all processors. Throws UsageError. */
int threadsOf(int asked);

/** Makes the standard streams safe to write to: descriptors that are closed are opened to
 * /dev/null, else the first file that is opened would get what is meant for them. A reader who has
 * gone away and a file that reaches its limit make writing fail instead of ending the program
 * (SIGPIPE and SIGXFSZ are ignored), so that what was done is saved. */
void guardStandardStreams();

/** Writes out what is left for the standard output. False if that, or anything before, could not be
 * written. */
bool flushStandardOutput();

/** The command line that was given, with one more option or another value of it, to be copied into
 * a shell. */
std::string commandLineWith(
    const std::vector<std::string>& words, const std::string& option, const std::string& value);

/** Calls `body` and gives the exit code: what it returns (0 if nothing), 1 failed, 2 bad usage or a
 * configuration that cannot be used. An output that could not be written is a failure. `words` is
 * the command line, for the advice how to change it. */
template <class Body>
int runProgram(const std::string& name, Body body, const std::vector<std::string>& words = {})
{
    guardStandardStreams();
    try
    {
        int code = 0;
        if constexpr (std::is_void_v<decltype(body())>)
            body();
        else
            code = body();
        if (!flushStandardOutput()) throw std::runtime_error("cannot write to the standard output");
        return code;
    }
    catch (const UsageError& e)
    {
        std::cerr << name << ": " << e.what() << "; see " << name << " --help\n";
        return 2;
    }
    catch (const ConfigError& e)
    {
        std::cerr << name << ": " << e.what() << "\n";
        return 2;
    }
    catch (const ChoiceNeeded& e)
    {
        std::cerr << name << ": ";
        if (words.empty())
            std::cerr << e.what() << "\n";
        else
            std::cerr << e.text()
                      << "; choose one, as in: " << commandLineWith(words, e.option(), e.value())
                      << "\n";
        return 1;
    }
    catch (const std::exception& e)
    {
        std::cerr << name << ": " << e.what() << "\n";
        return 1;
    }
}
}  // namespace taut
