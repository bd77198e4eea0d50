#pragma once

#include <mrpt/obs/CObservation.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace taut
{
/** The observations that rawlog-grabber was given and has not written yet. It tells nobody, but it
 * keeps each one until it is in the file, and lets it go at its next pass. */
class Unwritten
{
 public:
    void add(const mrpt::obs::CObservation::Ptr& observation)
    {
        observations_.emplace_back(observation);
    }

    std::size_t count()
    {
        observations_.erase(
            std::remove_if(
                observations_.begin(), observations_.end(),
                [](const auto& o) { return o.expired(); }),
            observations_.end());
        return observations_.size();
    }

 private:
    std::vector<std::weak_ptr<const mrpt::obs::CObservation>> observations_;
};
}  // namespace taut
