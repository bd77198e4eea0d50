#include "Legend.h"

#include <mrpt/opengl/CText.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "Compose.h"
#include "taut/render/HeightColors.h"

namespace taut
{
namespace
{
constexpr double kLine = 1.6;     // distance of lines of text, in heights of the font
constexpr double kPadding = 0.9;  // free space around the strip's content, in heights of the font
constexpr int kLeastLines = 2;    // the bars take two
constexpr Rgb kInk{30, 30, 30};

std::string numberText(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f", std::abs(value) < 0.05 ? 0.0 : value);
    return text;
}

/** MRPT's fonts have ASCII characters alone; a line end would begin a new line. */
std::string printable(std::string text)
{
    for (char& c : text)
        if (c < ' ' || c > '~') c = c == '\t' || c == '\n' || c == '\r' ? ' ' : '?';
    return text;
}

void fill(Picture& picture, int x0, int y0, int x1, int y1, const Rgb& color)
{
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            if (picture.contains(x, y)) picture.pixels[picture.index(x, y)] = color;
}
}  // namespace

double roundNumber(double limit)
{
    const double power = std::pow(10, std::floor(std::log10(limit)));
    const double digits = limit / power * (1 + 1e-12);
    return power * (digits >= 5 ? 5 : digits >= 2 ? 2 : 1);
}

std::string lengthText(double metres)
{
    char text[32];
    if (metres >= 1000)
        std::snprintf(text, sizeof(text), "%g km", metres / 1000);
    else
        std::snprintf(text, sizeof(text), "%g m", metres);
    return text;
}

double Words::width() const
{
    mrpt::opengl::CText measure(printable(text));
    measure.setFont("sans", 20);
    return height * measure.computeTextExtension().first;
}

void printWords(
    Picture& picture, const std::vector<Words>& words, Offscreen& offscreen, int supersampling)
{
    ViewCamera camera;
    camera.size = {supersampling * picture.size.width, supersampling * picture.size.height};
    mrpt::opengl::COpenGLScene scene;
    mrpt::opengl::TFontParams font;
    font.vfont_name = "sans";
    font.color = {0, 0, 0};
    for (std::size_t i = 0; i < words.size(); ++i)
    {
        const Words& w = words[i];
        font.vfont_scale = static_cast<float>(w.height * supersampling);
        // from the lower left corner; below 1 would be a share of the picture
        scene.getViewport()->addTextMessage(
            std::max(1.0, w.x * supersampling),
            std::max(1.0, camera.size.height - w.y * supersampling), printable(w.text), i, font);
    }
    print(picture, averagedDown(offscreen.draw(scene, camera).picture, supersampling), 2);
}

double Legend::font(PixelSize picture) const
{
    const double lines = static_cast<double>(std::max<std::size_t>(caption.size(), kLeastLines));
    double size = std::clamp(picture.height * 0.016, 9.0, 60.0);
    // Not more than a third of the picture, however long the caption.
    size = std::min(size, picture.height / 3.0 / (lines * kLine + 2 * kPadding));
    for (const auto& line : caption)
        size *= std::min(1.0, 0.5 * picture.width / (Words{line, 0, 0, size}.width() + 1));
    return size;
}

int Legend::height(PixelSize picture) const
{
    const double lines = static_cast<double>(std::max<std::size_t>(caption.size(), kLeastLines));
    return static_cast<int>(std::lround(font(picture) * (lines * kLine + 2 * kPadding)));
}

std::vector<Words> Legend::draw(Picture& picture) const
{
    const PixelSize size = picture.size;
    const double f = font(size), line = kLine * f;
    const double top = size.height - height(size) + kPadding * f;
    fill(picture, 0, size.height - height(size), size.width, size.height, {255, 255, 255});
    std::vector<Words> words;
    for (std::size_t i = 0; i < caption.size(); ++i)
        words.push_back({caption[i], 1.5 * f, top + line * (static_cast<double>(i) + 0.75), f});

    // Both bars have their words above, centred.
    const auto y = static_cast<int>(top + line), bar = std::max(3, static_cast<int>(0.7 * f));
    const auto center = [&](const std::string& text, double x)
    {
        Words w{text, 0, top + 0.75 * line, f};
        w.x = x - w.width() / 2;
        words.push_back(w);
    };
    if (heights.size() > 0)
    {
        const int x1 = size.width - static_cast<int>(1.5 * f), x0 = x1 - size.width / 6;
        for (int x = x0; x < x1; ++x)
            fill(
                picture, x, y, x + 1, y + bar,
                heightColor(static_cast<double>(x - x0) / (x1 - x0)));
        center("height [m]", (x0 + x1) / 2.0);
        words.push_back({numberText(heights.low), static_cast<double>(x0), y + bar + 1.2 * f, f});
        Words high{numberText(heights.high), 0, y + bar + 1.2 * f, f};
        high.x = x1 - high.width();
        words.push_back(high);
    }
    const double middle = 0.68 * size.width;
    if (metres_per_pixel > 0)
    {
        const double length = roundNumber(size.width / 6.0 * metres_per_pixel);
        const auto half = static_cast<int>(std::lround(length / metres_per_pixel / 2));
        const int x0 = static_cast<int>(middle) - half, x1 = static_cast<int>(middle) + half;
        const int thick = std::max(2, static_cast<int>(f / 6));
        fill(picture, x0, y + bar / 2, x1, y + bar / 2 + thick, kInk);
        fill(picture, x0, y, x0 + thick, y + bar + thick, kInk);
        fill(picture, x1 - thick, y, x1, y + bar + thick, kInk);
        center(lengthText(length), middle);
    }
    else
    {
        center("grid " + lengthText(grid_step), middle);
    }
    return words;
}
}  // namespace taut
