#pragma once

#include <cstddef>
#include <string>

#include "taut/report/Report.h"

namespace taut
{
inline constexpr std::size_t kLargestReport = 15'000'000;  //!< [bytes]

/** Writes a page of HTML that needs nothing but itself: opened from the disk, without a network.
 * It takes at most `max_bytes`: the points get as much as the rest leaves, evenly thinned, and
 * their coordinates are rounded to a 65535th of the box around them. Long lists and texts are cut,
 * and the page says so. The file appears under its name when it is complete.
 *
 * Throws std::invalid_argument if a plot's curves and times differ in length, std::runtime_error if
 * the file cannot be written, or if `max_bytes` is too little for everything but the points. */
void writeReport(
    const Report& report, const std::string& path, std::size_t max_bytes = kLargestReport);
}  // namespace taut
