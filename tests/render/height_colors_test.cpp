#include "taut/render/HeightColors.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace taut;

namespace
{
/** Lightness L* of CIELAB, 0 to 100. */
double lightness(const Rgb& color)
{
    const auto linear = [](std::uint8_t channel)
    {
        const double c = channel / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    const double luminance =
        0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
    return 116 * std::cbrt(luminance) - 16;
}
}  // namespace

TEST(HeightColors, LightnessFallsEvenly)
{
    const double step = (lightness(heightColor(1)) - lightness(heightColor(0))) / 20;
    EXPECT_LT(step, -2.5);
    for (int i = 0; i < 20; ++i)
        EXPECT_NEAR(
            lightness(heightColor((i + 1) / 20.0)) - lightness(heightColor(i / 20.0)), step, 1.0)
            << i;
}

TEST(HeightColors, HeightsOutOfRangeTakeTheColorOfItsEnd)
{
    EXPECT_EQ(heightColor(-3), heightColor(0));
    EXPECT_EQ(heightColor(7), heightColor(1));
}
