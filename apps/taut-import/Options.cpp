#include "Options.h"

#include "../ImportArguments.h"
#include "../scanTimesOf.h"

namespace taut
{
bool parseOptions(int argc, char** argv, Options& o)
{
    TCLAP::CmdLine cmd(
        "taut-import: turns a recording of another format (docs/importing.md) into a rawlog. Exit "
        "codes: 0 done, 1 failed, 2 bad usage, 3 done, but part of the recording could not be used "
        "(the warnings say which and why).",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> source(
        "source", "The recording: a file or a folder", true, "", "SOURCE", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output", "Rawlog to write", true, "", "LOG.rawlog", cmd);
    TCLAP::ValueArg<std::string> rig(
        "r", "rig", "Rig file: poses, units and clocks of the sensors, over the recording's", false,
        "", "RIG.yaml", cmd);
    TCLAP::ValueArg<std::string> lidar(
        "", "lidar-label", "Sensor label of the LiDAR in the rawlog (default: LIDAR)", false,
        "LIDAR", "LABEL", cmd);
    TCLAP::ValueArg<std::string> imu(
        "", "imu-label", "Sensor label of the IMU in the rawlog (default: IMU)", false, "IMU",
        "LABEL", cmd);
    ImportArguments import(cmd);
    TCLAP::ValueArg<std::string> scan_times(
        "", "scan-times",
        "Clouds without times of their points: azimuth tells them, or none (default auto: the "
        "azimuth of a sensor that turns, unless the clouds are undistorted already)",
        false, "auto", "auto|azimuth|none", cmd);
    TCLAP::SwitchArg overwrite("w", "overwrite", "Replace a rawlog that is there", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "Errors and warnings only", cmd);
    const Usage usage{
        {"drive.bag -o drive.rawlog", "walk.pcap -o walk.rawlog --ouster-json sensor.json"}};
    if (!parseCommandLine(cmd, argc, argv, usage)) return false;

    o.source = source.getValue();
    o.output = output.getValue();
    o.rig = rig.getValue();
    o.lidar_label = lidar.getValue();
    o.imu_label = imu.getValue();
    o.import = import.options();
    o.import.scan_times = scanTimesOf(scan_times.getValue());
    o.overwrite = overwrite.getValue();
    o.quiet = quiet.getValue();
    return true;
}
}  // namespace taut
