#pragma once

#include <string>

#include "taut/core/Warning.h"
#include "taut/odometry/Events.h"

namespace taut
{
/** Poses for other programs while they are estimated: a line of JSON for each scan on the standard
 * output (docs/live.md). Tells what each scan showed at once; loops that are closed later do not
 * change it. */
class PoseStream
{
 public:
    enum class WhereNobodyReads
    {
        Wait,  //!< until there is room
        Drop   //!< the line: the estimation does not wait for a slow reader
    };

    /** Warnings: `stream_ended` if the output cannot be written any more. */
    PoseStream(WhereNobodyReads then, WarningSink warn);

    void add(const Event& event);

    /** Tells, by the warning `stream_behind`, of lines that a slow reader did not get. */
    void finish();

    static std::string lineOf(const NavEstimate& estimate, bool doubtful);

 private:
    void write(const std::string& line, Time t);

    WhereNobodyReads then_;
    WarningSink warn_;
    bool doubtful_ = false, ended_ = false;
    std::size_t dropped_ = 0;
    Time last_ = 0;
};
}  // namespace taut
