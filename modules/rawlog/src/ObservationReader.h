#pragma once

#include <mrpt/obs/CObservation.h>

#include <deque>
#include <string>

#include "GzInput.h"

namespace taut
{
/** Gives the observations of a rawlog one by one, whichever of the two formats it has. */
class ObservationReader
{
 public:
    /** Throws std::runtime_error naming the file if it is missing, empty or no rawlog. */
    explicit ObservationReader(const std::string& path);

    /** The next one in the order of the file; null at the end or where the file cannot be read on.
     */
    mrpt::obs::CObservation::Ptr next();

    /** Why the reading stopped before the end of the log; empty if it did not. */
    const std::string& damage() const { return damage_; }

    std::uint64_t bytesRead() const { return input_.compressedPosition(); }
    std::uint64_t bytesTotal() const { return input_.compressedSize(); }

 private:
    bool readObject();

    GzInput input_;
    std::deque<mrpt::obs::CObservation::Ptr> queue_;  // of the sensory frame being given out
    std::string damage_;
    std::size_t objects_ = 0;
    bool finished_ = false;
};
}  // namespace taut
