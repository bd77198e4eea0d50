#include "Compose.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace taut
{
namespace
{
std::uint8_t blend(std::uint8_t under, float over, float opacity)
{
    const auto u = static_cast<float>(under);
    return static_cast<std::uint8_t>(u + (over - u) * opacity + 0.5F);
}

/** Share of ink [0, 1] on each pixel. */
std::vector<float> coverage(const Picture& ink)
{
    std::vector<float> cover(ink.pixels.size());
    std::transform(
        ink.pixels.begin(), ink.pixels.end(), cover.begin(),
        [](const Rgb& pixel) { return 1 - static_cast<float>(pixel[0]) / 255; });
    return cover;
}

/** The largest value within `radius` pixels in x and y. */
std::vector<float> dilated(const std::vector<float>& values, const Picture& grid, int radius)
{
    std::vector<float> result(values.size(), 0);
    for (int y = 0; y < grid.size.height; ++y)
        for (int x = 0; x < grid.size.width; ++x)
        {
            const float value = values[grid.index(x, y)];
            if (value <= 0) continue;
            for (int j = y - radius; j <= y + radius; ++j)
                for (int i = x - radius; i <= x + radius; ++i)
                    if (grid.contains(i, j))
                        result[grid.index(i, j)] = std::max(result[grid.index(i, j)], value);
        }
    return result;
}

/** Mean over eight neighbours of how far they are before the pixel [m], less the tolerance. */
float stepBehindNeighbours(const Layer& layer, int x, int y, int radius, float tolerance)
{
    const float depth = layer.depth[layer.picture.index(x, y)];
    float sum = 0;
    for (int j = y - radius; j <= y + radius; j += radius)
        for (int i = x - radius; i <= x + radius; i += radius)
        {
            if (!layer.picture.contains(i, j)) continue;
            const float other = layer.depth[layer.picture.index(i, j)];
            if (other > 0) sum += std::max(0.F, depth - other - tolerance);
        }
    return sum / 8;
}
}  // namespace

void shadeByDepth(Layer& layer, const ViewCamera& camera, int radius, double tolerance)
{
    constexpr float kStrength = 60, kDarkest = 0.3F;
    // Steps count relative to the size of the view, so that all scales look alike.
    const double view_size =
        2 * layer.picture.size.height * camera.metresPerPixel(camera.focus_depth);
    for (int y = 0; y < layer.picture.size.height; ++y)
        for (int x = 0; x < layer.picture.size.width; ++x)
        {
            const std::size_t i = layer.picture.index(x, y);
            if (layer.depth[i] <= 0) continue;
            const float step =
                stepBehindNeighbours(layer, x, y, radius, static_cast<float>(tolerance));
            if (step <= 0) continue;
            const float scale =
                camera.orthographic ? static_cast<float>(view_size) : 2 * layer.depth[i];
            const float light = kDarkest + (1 - kDarkest) * std::exp(-kStrength * step / scale);
            for (auto& channel : layer.picture.pixels[i])
                channel = blend(0, static_cast<float>(channel), light);
        }
}

void paintOver(Picture& picture, const Layer& layer, const Layer& hider, double opacity_if_hidden)
{
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    {
        const float depth = layer.depth[i], other = hider.depth[i];
        if (depth <= 0) continue;
        const bool hidden = other > 0 && other < depth;
        const float opacity = hidden ? static_cast<float>(opacity_if_hidden) : 1.F;
        for (std::size_t c = 0; c < 3; ++c)
        {
            auto& channel = picture.pixels[i][c];
            channel = blend(channel, static_cast<float>(layer.picture.pixels[i][c]), opacity);
        }
    }
}

Picture averagedDown(const Picture& picture, int factor)
{
    Picture result({picture.size.width / factor, picture.size.height / factor});
    const int area = factor * factor;
    for (int y = 0; y < result.size.height; ++y)
        for (int x = 0; x < result.size.width; ++x)
        {
            std::array<int, 3> sum{area / 2, area / 2, area / 2};
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i)
                {
                    const Rgb& p = picture.pixels[picture.index(x * factor + i, y * factor + j)];
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += p[c];
                }
            for (std::size_t c = 0; c < 3; ++c)
                result.pixels[result.index(x, y)][c] = static_cast<std::uint8_t>(sum[c] / area);
        }
    return result;
}

void print(Picture& picture, const Picture& ink, int rim)
{
    constexpr float kPaper = 255, kInk = 30, kRimOpacity = 0.8F;
    const std::vector<float> cover = coverage(ink), light = dilated(cover, ink, rim);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        for (auto& channel : picture.pixels[i])
            channel = blend(blend(channel, kPaper, kRimOpacity * light[i]), kInk, cover[i]);
}
}  // namespace taut
