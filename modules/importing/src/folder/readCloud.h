#pragma once

#include <filesystem>
#include <optional>

#include "taut/core/Scan.h"

namespace taut
{
/** The stamp that is a file's name: nanoseconds (16 digits or more) or seconds with decimals. */
std::optional<Time> stampOfName(const std::filesystem::path& file);

/** True if its ending is one that readCloud() knows. */
bool isCloud(const std::filesystem::path& file);

/** A scan from a CSV, PLY or PCD file (docs/importing.md). The stamp is the time of the first
 * point. Throws std::runtime_error naming the file and what is missing or wrong in it. */
Scan readCloud(const std::filesystem::path& file);
}  // namespace taut
