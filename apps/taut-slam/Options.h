#pragma once

#include <string>
#include <vector>

#include "taut/rawlog/RawlogSource.h"

namespace taut
{
/** What the command line says. */
struct Options
{
    RawlogConfig log;  //!< of the recording, whatever its format
    std::string output;
    std::string config;                 //!< method file; empty: config/default.yaml
    std::vector<std::string> settings;  //!< section.key=value, over the method file
    std::string rig;
    std::string map;               //!< results of an earlier run; empty: none
    bool extend_map = false;       //!< its submaps may move and belong to the results
    std::vector<double> start_at;  //!< x, y, z [m], yaw [rad] in that map; empty: not known
    std::vector<std::string> plugins;
    int threads = 0;    //!< 0: as many as the machine has
    std::string truth;  //!< trajectory that report.html compares the run with; empty: none
    bool overwrite = false, no_pictures = false, no_report = false, show_config = false;
    int verbosity = 2;  //!< 0 errors, 1 warnings, 2 progress, 3 every scan
};

/** False if that was all there was to do (--help, --version). Throws UsageError. */
bool parseOptions(int argc, char** argv, Options& options);
}  // namespace taut
