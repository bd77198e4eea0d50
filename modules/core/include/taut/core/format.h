#pragma once

#include <cstdio>
#include <string>

namespace taut
{
/** printf to a string, for texts with numbers. At most 511 characters. */
template <class... Values>
std::string format(const char* text, Values... values)
{
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, text, values...);
    return buffer;
}
}  // namespace taut
