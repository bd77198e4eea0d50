#pragma once

#include <string>

#include "taut/importing/ImportOptions.h"

namespace taut
{
/** What the command line says. */
struct Options
{
    std::string source, output;
    std::string rig;
    std::string lidar_label, imu_label;
    ImportOptions import;
    bool overwrite = false, quiet = false;
};

/** False if that was all there was to do (--help, --version). Throws UsageError. */
bool parseOptions(int argc, char** argv, Options& options);
}  // namespace taut
