#pragma once

#include <string>

namespace taut
{
/** The text with each byte that is not part of valid UTF-8 replaced by U+FFFD. */
std::string validUtf8(const std::string& text);
}  // namespace taut
