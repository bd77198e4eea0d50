#pragma once

#include <charconv>
#include <cstring>
#include <string>
#include <vector>

namespace taut
{
/** The number that stands in a file, lowest byte first. */
template <class T>
double valueAt(const char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
}

/** Fills `row` with the numbers that a line begins with, separated by blanks; false if there are
 * fewer. */
inline bool parseRow(const std::string& line, std::vector<double>& row)
{
    const char* p = line.data();
    const char* const end = p + line.size();
    for (double& value : row)
    {
        while (p != end && (*p == ' ' || *p == '\t')) ++p;
        const auto result = std::from_chars(p, end, value);
        if (result.ec != std::errc{}) return false;
        p = result.ptr;
    }
    return true;
}
}  // namespace taut
