#pragma once

#include <exception>
#include <string>

namespace taut
{
/** What an exception says, in one line: MRPT's put theirs between a headline and a call stack. */
inline std::string errorText(const std::exception& e)
{
    const std::string text = e.what(), mark = "Message:";
    const auto found = text.find(mark);
    const auto from =
        text.find_first_not_of(" \n\r\t", found == std::string::npos ? 0 : found + mark.size());
    if (from == std::string::npos) return "unknown error";
    return text.substr(from, text.find_first_of("\n\r", from) - from);
}
}  // namespace taut
