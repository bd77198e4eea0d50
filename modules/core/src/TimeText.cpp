#include "taut/core/TimeText.h"

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr Time kSecond = 1'000'000'000;

/** Digits of a decimal number without its point: value = digits * 10^exponent. */
struct Decimal
{
    bool negative = false;
    std::string digits;
    int exponent = 0;
};

Decimal parseDecimal(const std::string& text)
{
    const auto fail = [&] { throw std::invalid_argument("'" + text + "' is not a time"); };
    Decimal out;
    std::size_t i = 0;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) out.negative = text[i++] == '-';
    bool point = false;
    for (; i < text.size() && ((text[i] >= '0' && text[i] <= '9') || text[i] == '.'); i++)
    {
        if (text[i] != '.')
        {
            out.digits += text[i];
            out.exponent -= point ? 1 : 0;
        }
        else if (point)
            fail();
        else
            point = true;
    }
    if (out.digits.empty()) fail();
    if (i == text.size()) return out;
    if (text[i] != 'e' && text[i] != 'E') fail();
    if (++i < text.size() && text[i] == '+') i++;
    if (text[i - 1] == '+' && i < text.size() && text[i] == '-') fail();
    int power = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + i, end, power);
    if (error != std::errc() || stop != end || std::abs(power) > 1000) fail();
    out.exponent += power;
    return out;
}
}  // namespace

Time parseSeconds(const std::string& text)
{
    const Decimal decimal = parseDecimal(text);
    // The digits up to 1e-9 s are kept, the first one after them rounds.
    const auto size = static_cast<std::int64_t>(decimal.digits.size());
    const std::int64_t kept = size + decimal.exponent + 9;
    Time ns = 0;
    for (std::int64_t i = 0; i < kept; i++)
    {
        const int digit = i < size ? decimal.digits[static_cast<std::size_t>(i)] - '0' : 0;
        if (ns > (std::numeric_limits<Time>::max() - digit - 1) / 10)
            throw std::invalid_argument("time '" + text + "' is out of range");
        ns = ns * 10 + digit;
    }
    if (kept >= 0 && kept < size && decimal.digits[static_cast<std::size_t>(kept)] >= '5') ns++;
    return decimal.negative ? -ns : ns;
}

std::string formatSeconds(Time t)
{
    // Unsigned: the magnitude of the smallest Time has no signed counterpart.
    const std::uint64_t magnitude =
        t < 0 ? ~static_cast<std::uint64_t>(t) + 1 : static_cast<std::uint64_t>(t);
    const std::string decimals = std::to_string(magnitude % kSecond);
    return (t < 0 ? "-" : "") + std::to_string(magnitude / kSecond) + "." +
           std::string(9 - decimals.size(), '0') + decimals;
}
}  // namespace taut
