#pragma once

#include <functional>
#include <optional>
#include <string>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"

namespace taut
{
/** The loops of a run against the truth. */
struct LoopScores
{
    int loops = 0;  //!< in the graph
    int wrong = 0;  //!< of these: further off than 5 cm or half a degree, and than three of their
                    //!< deviations, in a direction that they show
    int revisits = 0;    //!< submaps that come within 3 m of an earlier one, which is no neighbour
    int recognised = 0;  //!< of these: with a loop that is right
    double largest_error = 0;  //!< [m] of all loops, in the directions that they show
    /** Mean of chi-square over degrees of freedom of the loops' errors, by their own information.
     */
    double nees = 0;

    double precision() const { return loops > 0 ? 1 - static_cast<double>(wrong) / loops : 1; }
    double recall() const { return revisits > 0 ? static_cast<double>(recognised) / revisits : 1; }
};

/** `folder`: results of a run with loops (graph.g2o, submaps). `truth`: pose of the body at a time,
 * if it is known then. Throws std::runtime_error if a file cannot be used. */
LoopScores scoreLoops(
    const std::string& folder, const std::function<std::optional<Pose>(Time)>& truth);
}  // namespace taut
