#pragma once

#include <string>

namespace taut
{
/** A text as a value of YAML on one line, which parseYaml() reads back to the same bytes. */
std::string quotedYaml(const std::string& text);
}  // namespace taut
