#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ObservationSource.h"

namespace mrpt::config
{
class CConfigFile;
}

namespace taut
{
/** The sensors of a file for MRPT's rawlog-grabber: each section with a `driver` is one, in a
 * thread of its own. Of `[global]` it takes time_between_launches and rawlog_GZ_compress_level; the
 * others are of rawlog-grabber alone. */
class SensorSource : public ObservationSource
{
 public:
    /** Throws ConfigError if the file cannot be read or has no sensor. */
    explicit SensorSource(const std::string& path);
    ~SensorSource() override;

    /** Of the log: 0 to 9. */
    int gzLevel() const { return gz_level_; }

    /** Starts the drivers one after the other. One that cannot be had ends all. */
    void start(Sink sink) override;
    void stop() override;
    std::optional<Ending> ending() const override;

 private:
    void run(const std::string& section, const Sink& sink);
    void pause(std::chrono::duration<double> time) const;
    void end(Ending ending);

    std::unique_ptr<mrpt::config::CConfigFile> config_;
    std::vector<std::string> sections_;
    int gz_level_ = 1, launch_pause_ms_ = 300;
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;
    std::optional<Ending> ending_;  // the first
    std::vector<std::thread> threads_;
};
}  // namespace taut
