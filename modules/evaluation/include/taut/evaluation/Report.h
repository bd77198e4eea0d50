#pragma once

#include <optional>
#include <string>

#include "taut/evaluation/MapScores.h"
#include "taut/slam/LoopScores.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/Scores.h"

namespace taut
{
/** What was scored. */
struct Evaluation
{
    std::optional<Scores> trajectory;
    std::optional<PointScores> points;
    std::optional<LoopScores> loops;
    std::optional<MapScores> map;
};

/** A table for people. */
std::string scoresAsText(const Evaluation& evaluation);

/** The same for programs: keys are stable, the unit stands at the end of a key. Those of the
 * trajectory are at the top, the others in "points", "loops" and "map". */
std::string scoresAsJson(const Evaluation& evaluation);
}  // namespace taut
