#pragma once

#include <cstdlib>
#include <filesystem>

namespace taut::test
{
/** Where the recordings are: $TAUT_DATA, or ../shared/data beside the project. May not exist. */
inline std::filesystem::path dataFolder()
{
    const char* given = std::getenv("TAUT_DATA");
    return given ? given : TAUT_DATA_DEFAULT;
}
}  // namespace taut::test
