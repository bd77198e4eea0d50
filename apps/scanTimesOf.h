#pragma once

#include <string>

#include "CommandLine.h"
#include "taut/completion/TurnFinder.h"

namespace taut
{
/** What --scan-times says. Throws UsageError. */
inline ScanTimes scanTimesOf(const std::string& text)
{
    if (text == "auto") return ScanTimes::Auto;
    if (text == "azimuth") return ScanTimes::Azimuth;
    if (text == "none") return ScanTimes::None;
    throw UsageError("--scan-times is auto, azimuth or none, not '" + text + "'");
}
}  // namespace taut
