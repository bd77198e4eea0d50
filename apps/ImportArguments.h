#pragma once

#include <string>

#include "CommandLine.h"
#include "taut/importing/ImportOptions.h"

namespace taut
{
/** The options of every program that reads recordings of other formats. */
class ImportArguments
{
 public:
    /** Adds them to the command line, which must be parsed before any of the following is asked. */
    explicit ImportArguments(TCLAP::CmdLine& cmd)
        : ouster_(
              "", "ouster-json",
              "Description of the Ouster that sent the packets (default: the name of the capture "
              "with .json)",
              false, "", "SENSOR.json", cmd),
          hesai_(
              "", "hesai-csv",
              "Correction file of the Hesai that sent the packets (default: one beside the "
              "recording, else the data sheet's angles)",
              false, "", "ANGLES.csv", cmd),
          capture_(
              "", "capture-clock",
              "Packets: stamps by the computer that captured them, instead of the sensor's clock",
              cmd),
          lidar_topic_(
              "", "lidar-topic", "Bags: topic of the LiDAR (default: the only one)", false, "",
              "REGEX", cmd),
          imu_topic_(
              "", "imu-topic", "Bags: topic of the IMU (default: the only one)", false, "", "REGEX",
              cmd),
          scan_stamp_(
              "", "scan-stamp",
              "Clouds: which end of a sweep their stamp is, start or end (default: as the times of "
              "the points, the IMU or the recorder tell)",
              false, "", "start|end", cmd),
          lidar_id_(
              "", "lidar-id",
              "Bags with several LiDARs on one topic: lidar_id (Livox) or frame_id of the one to "
              "take (default: the only one)",
              false, "", "REGEX", cmd),
          time_field_(
              "", "time-field",
              "Bags and folders: field with the times of the points, or none (default: found by "
              "its name)",
              false, "", "NAME", cmd)
    {
    }

    /** Throws UsageError. */
    ImportOptions options()
    {
        ImportOptions o;
        o.ouster_json = ouster_.getValue();
        o.hesai_csv = hesai_.getValue();
        o.capture_clock = capture_.getValue();
        o.lidar_topic = lidar_topic_.getValue();
        o.imu_topic = imu_topic_.getValue();
        const std::string& stamp = scan_stamp_.getValue();
        if (stamp == "start")
            o.scan_stamp = ScanStamp::Start;
        else if (stamp == "end")
            o.scan_stamp = ScanStamp::End;
        else if (!stamp.empty())
            throw UsageError("--scan-stamp is start or end, not '" + stamp + "'");
        o.lidar_id = lidar_id_.getValue();
        o.time_field = time_field_.getValue();
        return o;
    }

    /** One that was given and that a rawlog has no use for, as "--imu-topic"; empty if none was. */
    std::string given() const
    {
        const TCLAP::Arg* const all[] = {&ouster_,    &hesai_,      &capture_,  &lidar_topic_,
                                         &imu_topic_, &scan_stamp_, &lidar_id_, &time_field_};
        for (const TCLAP::Arg* arg : all)
            if (arg->isSet()) return "--" + arg->getName();
        return "";
    }

 private:
    TCLAP::ValueArg<std::string> ouster_, hesai_;
    TCLAP::SwitchArg capture_;
    TCLAP::ValueArg<std::string> lidar_topic_, imu_topic_, scan_stamp_, lidar_id_, time_field_;
};
}  // namespace taut
