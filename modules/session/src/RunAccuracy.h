#pragma once

#include "taut/core/Warning.h"
#include "taut/report/Report.h"
#include "taut/trajectory/Trajectory.h"

namespace taut
{
/** The errors of a run, aligned as taut-evaluate does it by default. Where they cannot be told, the
 * headline says why. */
ReportAccuracy accuracyOf(const Trajectory& truth, const Trajectory& estimate);
}  // namespace taut
