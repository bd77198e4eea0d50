#pragma once

#include <memory>
#include <optional>
#include <string>

#include "taut/core/Time.h"

namespace mrpt::obs
{
class CObservation;
}

namespace taut
{
/** Gives the observations of LiDARs and IMUs in a rawlog as they are, in the order of the file,
 * with the time at which a sensor could have given each: to play the sensors of a recording. */
class RawlogReplay
{
 public:
    /** Throws std::runtime_error naming the file if it is missing, empty or no rawlog. */
    explicit RawlogReplay(const std::string& path);
    ~RawlogReplay();

    struct Item
    {
        std::shared_ptr<mrpt::obs::CObservation> observation;
        /** Never earlier than that of the one before. Of a scan it is the time of the last point,
         * of another observation its stamp. A gap, or a stamp that leaps, counts as a second. */
        Time due = 0;
    };
    std::optional<Item> next();

    std::size_t leftOut() const { return left_out_; }  //!< of other sensors
    /** Why the reading ended before the end of the log; empty if it did not. */
    std::string damage() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::size_t left_out_ = 0;
};
}  // namespace taut
