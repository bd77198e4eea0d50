#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace taut
{
/** A number that stands in a recording with its lowest byte first: the order of every machine that
 * this builds for. */
template <class Number>
Number readLittle(const std::uint8_t* bytes)
{
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}
}  // namespace taut
