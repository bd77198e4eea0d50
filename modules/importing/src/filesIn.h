#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "taut/core/Scan.h"
#include "taut/core/Warning.h"

namespace taut
{
/** The files in a folder by name, numbers in the names by value: "2.ply" before "10.ply". Throws
 * std::runtime_error if the folder cannot be read. */
std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder);

/** Files that are read one after the other, one scan each. */
class FileQueue
{
 public:
    explicit FileQueue(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}

    std::size_t size() const { return files_.size(); }
    double progress() const;

    /** The scan of the next file that `read` does not throw std::runtime_error over; those before
     * are reported ("scan_invalid"). Nothing at the end. */
    std::optional<Scan> nextScan(
        const std::function<Scan(const std::filesystem::path&)>& read, const WarningSink& warn);

 private:
    std::vector<std::filesystem::path> files_;
    std::size_t next_ = 0;
};
}  // namespace taut
