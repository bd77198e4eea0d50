#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "ImportingSensor.h"
#include "Unwritten.h"
#include "taut/importing/ImportOptions.h"

namespace taut
{
/** Gives what is in a packet capture (Velodyne, Ouster with its IMU), stamped as taut-import stamps
 * it, at the pace at which it was measured. It gives no more than rawlog-grabber can write, and
 * ends the program, by an exception that says so, when all is written. Keys of its section:
 *   pcap_input     the capture (required)
 *   ouster_json    description of an Ouster; empty: the capture's name with .json
 *   capture_clock  stamps by the capturing computer instead of the sensor
 *   speed          1: as measured, 2: twice as fast, ...; 0: as fast as it can be written */
class PcapReplay : public ImportingSensor
{
    DEFINE_GENERIC_SENSOR(PcapReplay)
 public:
    PcapReplay() : ImportingSensor("PcapReplay") {}

    /** Throws std::runtime_error naming the capture and what is wrong with it. */
    void initialize() override;
    void doProcess() override;

 private:
    using Clock = std::chrono::steady_clock;

    void loadConfig_sensorSpecific(
        const mrpt::config::CConfigFileBase& config, const std::string& section) override;
    void fetch();
    void giveNext();
    void end();
    void waitForWriting();

    std::string path_;
    ImportOptions options_;
    double speed_ = 1;

    std::unique_ptr<ImportSource> source_;
    std::optional<ImportedItem> next_;
    Time now_ = 0;           // the latest stamp
    Clock::time_point due_;  // when next_ is to be given
    Unwritten unwritten_;
    std::size_t waiting_for_ = 0;
    Clock::time_point waiting_since_;
};
}  // namespace taut
