#pragma once

#include <string>

#include "../SlamArguments.h"

namespace taut
{
/** What the command line says. */
struct LiveOptions : SlamOptions
{
    std::string sensors;      //!< file for rawlog-grabber; empty: a recording is played
    std::string replay;       //!< rawlog; empty: the sensors
    double speed = 1;         //!< of the replay; 0: as fast as it is taken
    double duration = 0;      //!< [s]; 0: until a signal comes
    bool never_less = false;  //!< fall behind rather than use a share of each scan
};

/** False if that was all there was to do (--help, --version). Throws UsageError. */
bool parseOptions(int argc, char** argv, LiveOptions& options);
}  // namespace taut
