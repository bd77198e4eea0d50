#pragma once

#include <string>

#include "taut/trajectory/Scores.h"

namespace taut
{
/** A table for people. */
std::string scoresAsText(const Scores& scores);

/** The same for programs: keys are stable, the unit stands at the end of a key. */
std::string scoresAsJson(const Scores& scores);
}  // namespace taut
