#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "ObservationSource.h"
#include "ScanAges.h"
#include "taut/rawlog/RawlogRecorder.h"

namespace taut
{
/** Records what a source gives, from its construction on, beside whatever else is done: until it is
 * told to end, a time is over, or the source ends. Then the log is closed. */
class Recording
{
 public:
    /** `duration` [s]; 0: without an end. `is_ended` is asked again and again. */
    Recording(
        ObservationSource& source, RawlogRecorder& recorder, ScanAges& ages, double duration,
        std::function<bool()> is_ended);
    /** Ends it. */
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    void end() { end_ = true; }
    bool ended() const { return ended_; }
    void waitForEnd();

    /** After the end: how the source ended by itself; nothing if it did not. */
    const std::optional<ObservationSource::Ending>& ending() const { return ending_; }

 private:
    void watch(double duration, const std::function<bool()>& is_ended);

    ObservationSource& source_;
    RawlogRecorder& recorder_;
    ScanAges& ages_;
    std::atomic<bool> end_{false}, ended_{false};
    std::optional<ObservationSource::Ending> ending_;
    std::thread thread_;
};
}  // namespace taut
