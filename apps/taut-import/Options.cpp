#include "Options.h"

#include "../CommandLine.h"
#include "../scanTimesOf.h"

namespace taut
{
namespace
{
ScanStamp scanStamp(const std::string& text)
{
    if (text.empty()) return ScanStamp::Detect;
    if (text == "start") return ScanStamp::Start;
    if (text == "end") return ScanStamp::End;
    throw UsageError("--scan-stamp is start or end, not '" + text + "'");
}
}  // namespace

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
    TCLAP::ValueArg<std::string> ouster(
        "", "ouster-json",
        "Description of the Ouster that sent the packets (default: the name of the capture with "
        ".json)",
        false, "", "SENSOR.json", cmd);
    TCLAP::ValueArg<std::string> hesai(
        "", "hesai-csv",
        "Correction file of the Hesai that sent the packets (default: one beside the recording, "
        "else the data sheet's angles)",
        false, "", "ANGLES.csv", cmd);
    TCLAP::SwitchArg capture(
        "", "capture-clock",
        "Stamps by the computer that captured the packets, instead of the sensor's clock", cmd);
    TCLAP::ValueArg<std::string> lidar_topic(
        "", "lidar-topic", "Bags: topic of the LiDAR (default: the only one)", false, "", "REGEX",
        cmd);
    TCLAP::ValueArg<std::string> imu_topic(
        "", "imu-topic", "Bags: topic of the IMU (default: the only one)", false, "", "REGEX", cmd);
    TCLAP::ValueArg<std::string> scan_stamp(
        "", "scan-stamp",
        "Clouds: which end of a sweep their stamp is, start or end (default: as the times of the "
        "points, the IMU or the recorder tell)",
        false, "", "start|end", cmd);
    TCLAP::ValueArg<std::string> scan_times(
        "", "scan-times",
        "Clouds without times of their points: azimuth tells them, or none (default auto: the "
        "azimuth of a sensor that turns, unless the clouds are undistorted already)",
        false, "auto", "auto|azimuth|none", cmd);
    TCLAP::ValueArg<std::string> lidar_id(
        "", "lidar-id",
        "Bags with several LiDARs on one topic: lidar_id (Livox) or frame_id of the one to take "
        "(default: the only one)",
        false, "", "REGEX", cmd);
    TCLAP::ValueArg<std::string> time_field(
        "", "time-field",
        "Bags and folders: field with the times of the points, or none (default: found by its "
        "name)",
        false, "", "NAME", cmd);
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
    o.import.ouster_json = ouster.getValue();
    o.import.hesai_csv = hesai.getValue();
    o.import.capture_clock = capture.getValue();
    o.import.lidar_topic = lidar_topic.getValue();
    o.import.imu_topic = imu_topic.getValue();
    o.import.scan_stamp = scanStamp(scan_stamp.getValue());
    o.import.scan_times = scanTimesOf(scan_times.getValue());
    o.import.lidar_id = lidar_id.getValue();
    o.import.time_field = time_field.getValue();
    o.overwrite = overwrite.getValue();
    o.quiet = quiet.getValue();
    return true;
}
}  // namespace taut
