#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** Stamps that are the names of files: seconds with decimals ("1700000000.123456789", also with "_"
 * for the point), or whole numbers of 13 digits and more, whose unit all of them tell together. */
class NameStamps
{
 public:
    /** `span`: first and last time of the IMU, if there is one. The unit is that in which files
     * follow each other as sweeps do and lie where the IMU does; else by the number of digits. */
    explicit NameStamps(
        const std::vector<std::filesystem::path>& files,
        const std::optional<std::pair<Time, Time>>& span = {});

    /** Nothing if the name is no stamp. */
    std::optional<Time> of(const std::filesystem::path& file) const;

    /** How the names were taken; empty if they are no whole numbers. */
    const std::string& finding() const { return finding_; }

 private:
    Time unit_ = 1;  // [ns] of whole numbers
    std::string finding_;
};
}  // namespace taut
