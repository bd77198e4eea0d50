#pragma once

#include <stdexcept>

namespace taut
{
/** What a driver throws that plays a recording when all of it is written: rawlog-grabber ends by
 * any exception; taut-live knows this one for a good end. */
struct EndOfReplay : std::runtime_error
{
    EndOfReplay(const std::string& text, bool is_whole) : std::runtime_error(text), whole(is_whole)
    {
    }

    bool whole;  //!< nothing of the recording was left out
};
}  // namespace taut
