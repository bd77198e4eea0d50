#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace taut::test
{
/** Where the recordings are: $TAUT_DATA, or ../shared/data beside the project. May not exist. */
inline std::filesystem::path dataFolder()
{
    const char* given = std::getenv("TAUT_DATA");
    return given ? given : TAUT_DATA_DEFAULT;
}

/** Skips the running test because that recording is absent; with TAUT_REQUIRE_DATA=1 it fails.
 * The test returns: `if (!exists(log)) return skipWithout("x.rawlog");` */
inline void skipWithout(const std::string& recording)
{
    const std::string reason = "a recording is absent (TAUT_DATA, else ../shared/data): ";
    const char* required = std::getenv("TAUT_REQUIRE_DATA");
    if (required && std::string(required) == "1") FAIL() << reason << recording;
    GTEST_SKIP() << reason << recording;  // tests/skipped.sh counts what stands before the colon
}
}  // namespace taut::test
