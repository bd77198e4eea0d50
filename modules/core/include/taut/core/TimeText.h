#pragma once

#include <string>

#include "taut/core/Time.h"

namespace taut
{
/** Nanoseconds of a decimal text in seconds ("1700000000.123456789", "1.7e+09"), by integer
 * arithmetic alone; digits past the ninth decimal are rounded, half away from zero. Throws
 * std::invalid_argument if the text is no such number or does not fit. */
Time parseSeconds(const std::string& text);

/** The exact opposite: seconds with 9 decimals. */
std::string formatSeconds(Time t);
}  // namespace taut
