#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace mrpt::obs
{
class CObservation;
}

namespace taut
{
/** Gives observations, from threads of its own, until it is told to stop. */
class ObservationSource
{
 public:
    using Clock = std::chrono::steady_clock;

    /** Gets each observation once, and the time when it was measured to its end. May be called from
     * several threads at once. What it throws ends the source. */
    using Sink =
        std::function<void(const mrpt::obs::CObservation& observation, Clock::time_point whole)>;

    /** How a source ended by itself. */
    struct Ending
    {
        enum class How
        {
            Whole,   //!< it gave all there was
            Partly,  //!< something was left out
            Failed
        };
        How how = How::Failed;
        std::string text;
    };

    virtual ~ObservationSource() = default;

    virtual void start(Sink sink) = 0;

    /** From the return on nothing more is given. */
    virtual void stop() = 0;

    /** Nothing while it goes on. */
    virtual std::optional<Ending> ending() const = 0;
};
}  // namespace taut
