#pragma once

#include <cstddef>
#include <vector>

#include "taut/render/HeightColors.h"
#include "taut/render/ViewCamera.h"

namespace taut
{
/** Pixels row by row, from the upper left corner. */
struct Picture
{
    PixelSize size;
    std::vector<Rgb> pixels;

    explicit Picture(PixelSize s, Rgb color = {255, 255, 255})
        : size(s),
          pixels(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height), color)
    {
    }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size.width + x); }
    bool contains(int x, int y) const
    {
        return x >= 0 && y >= 0 && x < size.width && y < size.height;
    }
};

/** A drawn scene. */
struct Layer
{
    Picture picture;
    std::vector<float> depth;  //!< of each pixel [m], along the view; 0 where nothing was drawn
};
}  // namespace taut
