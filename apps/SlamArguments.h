#pragma once

#include <string>
#include <vector>

#include "CommandLine.h"
#include "taut/completion/TurnFinder.h"

namespace taut
{
/** What the command lines of taut-slam and taut-live have in common. */
struct SlamOptions
{
    std::string output;
    std::string config;                 //!< method file; empty: config/default.yaml
    std::vector<std::string> settings;  //!< section.key=value, over the method file
    std::string rig;
    std::string map;                     //!< results of an earlier run; empty: none
    bool extend_map = false;             //!< its submaps may move and belong to the results
    std::vector<double> start_at;        //!< x, y, z [m], yaw [rad] in that map; empty: not known
    std::string lidar_label, imu_label;  //!< regular expressions; empty: the only sensor there
    ScanTimes scan_times = ScanTimes::Auto;  //!< of scans without times
    std::vector<std::string> plugins;
    int threads = 0;  //!< 0: as many as the machine has
    bool overwrite = false, no_pictures = false, no_report = false;
    bool stream = false;  //!< poses to the standard output
    int verbosity = 2;    //!< 0 errors, 1 warnings, 2 progress, 3 every scan
};

/** Whether -o may be left out, as where the folder is named after the recording. */
enum class FolderOption
{
    Required,
    Optional,
};

/** The options of both, but for those of the sensors and the log. */
class SlamArguments
{
 public:
    /** Adds them to the command line. */
    SlamArguments(TCLAP::CmdLine& cmd, FolderOption folder);

    /** What was given; after the command line was parsed. Throws UsageError. */
    void fill(SlamOptions& options);

 private:
    TCLAP::ValueArg<std::string> output_, config_;
    TCLAP::MultiArg<std::string> set_;
    TCLAP::ValueArg<std::string> map_;
    TCLAP::SwitchArg localize_, extend_;
    TCLAP::ValueArg<std::string> start_;
    TCLAP::MultiArg<std::string> plugins_;
    TCLAP::ValueArg<int> threads_;
    TCLAP::SwitchArg overwrite_, stream_, no_pictures_, no_report_, quiet_;
    TCLAP::ValueArg<std::string> level_;
};
}  // namespace taut
