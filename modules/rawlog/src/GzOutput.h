#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace taut
{
/** A compressed file that gets its name only when it is complete. While it is written nobody else
 * writes it. */
class GzOutput
{
 public:
    /** Opens `path` + ".part" and locks it. Throws std::runtime_error naming the file and the
     * cause.
     */
    explicit GzOutput(std::string path);
    /** Removes what was written unless close() was called. */
    ~GzOutput();
    GzOutput(const GzOutput&) = delete;
    GzOutput& operator=(const GzOutput&) = delete;

    void write(const std::vector<std::uint8_t>& bytes);
    void close();

 private:
    [[noreturn]] void throwFailed(const std::string& cause) const;

    std::string path_, part_;
    gzFile file_ = nullptr;
};
}  // namespace taut
