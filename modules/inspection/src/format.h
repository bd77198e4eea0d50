#pragma once

#include <cstdio>
#include <string>

namespace taut
{
/** printf to a string. */
template <class... Values>
std::string format(const char* pattern, Values... values)
{
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}
}  // namespace taut
