#pragma once

#include <string>
#include <vector>

#include "taut/report/Report.h"
#include "taut/trajectory/Trajectory.h"

namespace taut
{
inline constexpr std::size_t kMostSamples = 16'384;  //!< of a curve and of the path on the page

/** Speed and turning of the body from pose to pose. */
std::vector<ReportPlot> motionPlots(const Trajectory& path);

/** What states.csv tells of each scan: matches, deviations, biases, information. Throws
 * std::runtime_error if it cannot be read. */
std::vector<ReportPlot> statePlots(const std::string& states_csv);

/** Milliseconds a stage and points a scan, of timing.csv. The same. */
std::vector<ReportPlot> timingPlots(const std::string& timing_csv);
}  // namespace taut
