#pragma once

#include <regex>
#include <stdexcept>
#include <string>

namespace taut
{
/** Compiles a label expression; throws std::runtime_error quoting it if it is not valid. */
inline std::regex labelExpression(const std::string& text)
{
    try
    {
        return std::regex(text, std::regex::ECMAScript);
    }
    catch (const std::regex_error& e)
    {
        throw std::runtime_error(
            "the sensor label '" + text + "' is not a regular expression: " + e.what());
    }
}
}  // namespace taut
