#pragma once

#include <array>
#include <cstdint>

namespace taut
{
using Rgb = std::array<std::uint8_t, 3>;  //!< sRGB

/** Colour of a height; `t` runs from 0, the lowest, to 1, the highest, and is clamped. Pale yellow,
 * green, blue, dark violet: a straight line of falling lightness in OKLCh, so that equal steps of
 * height look equal, colour-blind readers see them, and a print in grey still shows them. Colour
 * space: B. Ottosson, "A perceptual color space for image processing", 2020. */
Rgb heightColor(double t);
}  // namespace taut
