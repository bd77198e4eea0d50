#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "taut/core/Submap.h"

namespace taut
{
/** A submap seen from above: where something stands, how high it reaches over the ground, and in
 * which directions walls run. Made of its thinned points, so that it hardly depends on how many
 * rays the sensor has. */
struct ViewFromAbove
{
    static constexpr double kCell = 1.0;    //!< [m] edge of a cell
    static constexpr int kDirections = 60;  //!< of 3 degrees; a wall has no front
    static constexpr double kBand = 0.5;    //!< [m] of height, a bit of a profile each

    /** Something upright: at least three bands of its cell are occupied. */
    struct Cell
    {
        std::int16_t x = 0, y = 0;  //!< in cells from the origin of the submap
        std::uint16_t profile = 0;  //!< bit i: from i to i + 1 bands above the ground
        float ground = 0;           //!< height of the ground there, submap frame [m]
        Eigen::Vector2f middle;     //!< of its points, submap frame [m]
    };

    std::vector<Cell> cells;                      //!< in the order of (x, y)
    std::array<float, kDirections> directions{};  //!< how much wall runs that way; sum 1

    static ViewFromAbove of(const Submap& submap);
};

/** Where one view may lie on another. */
struct ViewMatch
{
    Pose T_from_to;
    double score = 0;  //!< share of the cells of the smaller view that lie on cells alike, 0 to 1
};

/** The best matches over all turns and shifts, best first, at most `most`; exhaustive: the same
 * views give the same matches. */
std::vector<ViewMatch> matchViews(
    const ViewFromAbove& from, const ViewFromAbove& to, std::size_t most);
}  // namespace taut
