#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "ObservationSource.h"
#include "taut/rawlog/RawlogReplay.h"

namespace taut
{
/** Plays the sensors of a rawlog at their pace: each observation is given when the sensor had it
 * whole. */
class ReplaySource : public ObservationSource
{
 public:
    /** `speed`: 1 as measured, 2 twice as fast, ...; 0: as fast as it is taken. Throws
     * std::runtime_error if the log cannot be read. */
    ReplaySource(const std::string& path, double speed);
    ~ReplaySource() override;

    void start(Sink sink) override;
    void stop() override;
    std::optional<Ending> ending() const override;

 private:
    void play(const Sink& sink);
    bool waitUntil(Clock::time_point t);
    void end(Ending ending);

    std::string path_;
    double speed_;
    RawlogReplay replay_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool stop_ = false;
    std::optional<Ending> ending_;
    std::thread thread_;
};
}  // namespace taut
