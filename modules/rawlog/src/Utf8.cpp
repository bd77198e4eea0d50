#include "Utf8.h"

#include <cstddef>
#include <cstdint>

namespace taut
{
namespace
{
/* Bytes of the valid character that begins at `at`; 0 if there is none. */
std::size_t lengthOfCharacter(const std::string& text, std::size_t at)
{
    const auto byte = [&text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t first = byte(at);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() - at < length) return 0;
    for (std::size_t i = 1; i < length; i++)
        if ((byte(at + i) & 0xc0) != 0x80) return 0;
    const std::uint8_t second = byte(at + 1);
    const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool surrogate = first == 0xed && second >= 0xa0;
    const bool too_large = first == 0xf4 && second >= 0x90;
    return overlong || surrogate || too_large ? 0 : length;
}
}  // namespace

std::string validUtf8(const std::string& text)
{
    std::string valid;
    for (std::size_t i = 0; i < text.size();)
    {
        const std::size_t length = lengthOfCharacter(text, i);
        valid += length > 0 ? text.substr(i, length) : "\xef\xbf\xbd";
        i += length > 0 ? length : 1;
    }
    return valid;
}
}  // namespace taut
