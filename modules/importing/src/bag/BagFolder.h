#pragma once

#include <filesystem>
#include <vector>

namespace taut::bag
{
/** Files that a bag's folder may hold. */
bool hasBagName(const std::filesystem::path& file);

/** The parts of a bag in their order: as metadata.yaml lists them, whether they are there or not;
 * without one, by the number at the end of their names. Throws std::runtime_error naming the
 * folder if metadata.yaml cannot be read or lists nothing. */
std::vector<std::filesystem::path> partsOfBag(const std::filesystem::path& folder);
}  // namespace taut::bag
