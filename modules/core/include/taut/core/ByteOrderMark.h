#pragma once

#include <string>

namespace taut
{
/** Takes away the mark that some programs put before a text in UTF-8, from the first line of a
 * file.
 */
inline void dropByteOrderMark(std::string& line)
{
    if (line.compare(0, 3, "\xEF\xBB\xBF") == 0) line.erase(0, 3);
}
}  // namespace taut
