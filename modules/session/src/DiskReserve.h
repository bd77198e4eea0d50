#pragma once

#include <filesystem>

namespace taut
{
/** Space on the disk that is kept for what is written last. */
class DiskReserve
{
 public:
    /** Takes it by a file in the folder. Throws std::runtime_error, with the cause, if it is not
     * there. */
    explicit DiskReserve(const std::filesystem::path& folder);
    ~DiskReserve() { release(); }
    DiskReserve(const DiskReserve&) = delete;
    DiskReserve& operator=(const DiskReserve&) = delete;

    /** Gives it back: from now on others can use it. */
    void release();

 private:
    std::filesystem::path file_;
};
}  // namespace taut
