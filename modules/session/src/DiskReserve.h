#pragma once

#include <filesystem>

namespace taut
{
/** Space on the disk that is kept for what is written last. As long as this lives nobody else
 * writes to the folder. */
class DiskReserve
{
 public:
    /** Takes it by a file in the folder, which it locks. Throws std::runtime_error, with the cause,
     * if there is no space or another program writes to the folder. */
    explicit DiskReserve(const std::filesystem::path& folder);
    ~DiskReserve();
    DiskReserve(const DiskReserve&) = delete;
    DiskReserve& operator=(const DiskReserve&) = delete;

    /** Gives the space back: from now on other files can use it. */
    void release();

    /** Whether one lives for this folder, in any program. */
    static bool isTaken(const std::filesystem::path& folder);

 private:
    std::filesystem::path path_;
    int file_ = -1;
};
}  // namespace taut
