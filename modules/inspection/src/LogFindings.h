#pragma once

#include <map>
#include <string>

#include "taut/core/Warning.h"
#include "taut/inspection/Finding.h"
#include "taut/rawlog/RawlogSource.h"

namespace taut
{
/** Makes findings of what the reading of a rawlog warns of and counts: one a kind. */
class LogFindings
{
 public:
    void add(const Warning& warning);

    /** Notes since when there are points without finite coordinates or with an impossible time. */
    void watch(const StreamProgress& progress);

    /** `own_units`: the units were judged better than by the reader. */
    Findings findings(const StreamProgress& progress, bool own_units) const;

 private:
    std::map<std::string, Finding> by_kind_;
    Time first_nan_ = 0, first_bad_time_ = 0;
};
}  // namespace taut
