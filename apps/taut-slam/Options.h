#pragma once

#include <string>

#include "../SlamArguments.h"
#include "taut/rawlog/RawlogSource.h"

namespace taut
{
/** What the command line says. */
struct Options : SlamOptions
{
    RawlogConfig log;   //!< of the recording, whatever its format
    double follow = 0;  //!< [s] to wait for a log that is being written; 0: it is complete
    std::string truth;  //!< trajectory that report.html compares the run with; empty: none
    bool show_config = false;
};

/** False if that was all there was to do (--help, --version). Throws UsageError. */
bool parseOptions(int argc, char** argv, Options& options);
}  // namespace taut
