#pragma once

#include <optional>
#include <string>

#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/Scores.h"

namespace taut
{
/** A table for people. */
std::string scoresAsText(
    const Scores& scores, const std::optional<PointScores>& points = std::nullopt);

/** The same for programs: keys are stable, the unit stands at the end of a key. */
std::string scoresAsJson(
    const Scores& scores, const std::optional<PointScores>& points = std::nullopt);
}  // namespace taut
