#pragma once

#include <string>

#include "taut/core/Warning.h"
#include "taut/report/Report.h"
#include "taut/trajectory/Trajectory.h"

namespace taut
{
/** What the page of a run tells, out of the results in a folder; those of a run that was killed, or
 * of an older version, too. Memory is bounded: what is long is thinned while it is read.
 *
 * `truth`: where the body truly was; empty: not known. Warns (kind "report_incomplete", on the page
 * as well) of each result that is there and cannot be used. Throws std::runtime_error if the folder
 * holds no trajectory.tum that can be read. */
Report readRunReport(
    const std::string& folder, const Trajectory& truth = {}, const WarningSink& warn = {});
}  // namespace taut
