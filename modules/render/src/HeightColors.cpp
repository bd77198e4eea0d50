#include "taut/render/HeightColors.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kDegree = M_PI / 180;

double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

/** Linear light in [0, 1] to the value that sRGB stores. */
std::uint8_t srgb(double linear)
{
    const double c = std::clamp(linear, 0.0, 1.0);
    const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * s));
}

Rgb fromOklab(double L, double a, double b)
{
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(L + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(L - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(L - 0.0894841775 * a - 1.2914855480 * b);
    return {
        srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
        srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
        srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}
}  // namespace

Rgb heightColor(double t)
{
    const double u = std::clamp(t, 0.0, 1.0);
    const double lightness = mix(0.92, 0.34, u);
    const double chroma = mix(0.095, 0.125, u);
    const double hue = mix(108, 295, u) * kDegree;
    return fromOklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}
}  // namespace taut
