#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut
{
/** The nearest return by direction, over the whole sphere: tells which space a sensor saw to be
 * free. Cells of 1.5 degrees of azimuth and elevation; 1 cm. A cell without a return says nothing:
 * glass and sky give none. */
class RangeImage
{
 public:
    static constexpr int kColumns = 240, kRows = 120;
    static constexpr double kLargest = 650;  //!< [m] further returns are not kept

    RangeImage() : cells_(static_cast<std::size_t>(kColumns) * kRows, 0) {}

    /** A return, in the frame of the sensor [m]. */
    void add(const Vector3d& point);

    /** The nearest return [m] in the cell of a direction and its eight neighbours; none: nothing
     * was measured in the cell itself. The neighbours keep a slanted surface from being seen
     * through at the edge of a cell. */
    std::optional<double> nearestAround(const Vector3d& direction) const;

    const std::vector<std::uint16_t>& cells() const { return cells_; }
    std::vector<std::uint16_t>& cells() { return cells_; }

 private:
    static int columnOf(const Vector3d& direction);
    static int rowOf(const Vector3d& direction);

    std::vector<std::uint16_t> cells_;  // [cm], row by row from straight down; 0: no return
};
}  // namespace taut
