#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace taut
{
/** The error of a file that did not take what was written, with the system's reason ("No space left
 * on device"). For right after the write that failed; errno has to be 0 before it, where the reason
 * may be another's. */
inline std::runtime_error writeError(const std::string& path)
{
    const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    return std::runtime_error("cannot write '" + path + "'" + reason);
}

/** Hands on to the system what was written to a stream. Throws writeError(). */
template <class Stream>
void flushOrThrow(Stream& file, const std::string& path)
{
    errno = 0;
    if (!file.flush()) throw writeError(path);
}
}  // namespace taut
