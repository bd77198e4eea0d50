#pragma once

#include <string>

#include "taut/trajectory/Scores.h"

namespace taut
{
enum class PlotFormat
{
    Svg,
    Png
};

/** Draws, with gnuplot, into a folder (made if need be): `trajectory` (seen from above, the
 * estimate aligned and coloured by its error, over the truth), `position_error` and
 * `rotation_error` over time. The data and the script stay beside the pictures. Throws
 * std::runtime_error if the folder cannot be written, or if gnuplot is absent or fails. */
void plotScores(
    const Scores& scores, const Trajectory& truth, const std::string& folder,
    PlotFormat format = PlotFormat::Svg);
}  // namespace taut
