#pragma once

#include <regex>
#include <string>

#include "taut/core/Config.h"

namespace taut
{
/** Compiles a label expression; throws ConfigError quoting it if it is not valid. */
inline std::regex labelExpression(const std::string& text)
{
    try
    {
        return std::regex(text, std::regex::ECMAScript);
    }
    catch (const std::regex_error& e)
    {
        throw ConfigError(
            "the sensor label '" + text + "' is not a regular expression: " + e.what());
    }
}
}  // namespace taut
