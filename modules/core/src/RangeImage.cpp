#include "taut/core/RangeImage.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kCentimetre = 0.01;
}

int RangeImage::columnOf(const Vector3d& d)
{
    const double turns = std::atan2(d.y(), d.x()) / (2 * M_PI) + 0.5;
    return std::min(static_cast<int>(turns * kColumns), kColumns - 1);
}

int RangeImage::rowOf(const Vector3d& d)
{
    const double share = std::atan2(d.z(), std::hypot(d.x(), d.y())) / M_PI + 0.5;
    return std::min(static_cast<int>(share * kRows), kRows - 1);
}

void RangeImage::add(const Vector3d& point)
{
    const double range = point.norm();
    if (!(range > kCentimetre) || range > kLargest) return;
    const auto cm = static_cast<std::uint16_t>(range / kCentimetre);
    std::uint16_t& cell =
        cells_[static_cast<std::size_t>(rowOf(point) * kColumns + columnOf(point))];
    cell = cell == 0 ? cm : std::min(cell, cm);
}

std::optional<double> RangeImage::nearestAround(const Vector3d& direction) const
{
    const int column = columnOf(direction), row = rowOf(direction);
    const auto at = [&](int r, int c)
    { return cells_[static_cast<std::size_t>(r * kColumns + (c + kColumns) % kColumns)]; };
    std::uint16_t nearest = at(row, column);
    if (nearest == 0) return {};
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, kRows - 1); r++)
        for (int c = column - 1; c <= column + 1; c++)
            if (at(r, c) != 0) nearest = std::min(nearest, at(r, c));
    return nearest * kCentimetre;
}
}  // namespace taut
