#pragma once

#include <string_view>
#include <vector>

namespace taut
{
/** The empty page in parts that follow on each other: made by embed_page.cmake. */
const std::vector<std::string_view>& pageParts();
}  // namespace taut
