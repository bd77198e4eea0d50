#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace taut
{
/** Points sorted into cubic cells, for all neighbours within a cell's size. 24 bytes a point at
 * most. Threads may share one. */
class PointGrid
{
 public:
    /** Cells of `cell` [m]. The points have to be finite. */
    PointGrid(const std::vector<Eigen::Vector3f>& points, double cell);

    /** In the order of the cells. */
    const std::vector<Eigen::Vector3f>& points() const { return points_; }
    double cell() const { return size_; }

    /** Cells that hold points. */
    std::size_t cells() const { return keys_.size(); }

    /** The points of a cell: begin and end. */
    std::pair<std::size_t, std::size_t> pointsOf(std::size_t cell) const
    {
        return {begins_[cell], begins_[cell + 1]};
    }

    /** Ranges of points in the 27 cells around that of p: all that are within a cell's size of p,
     * and others. */
    using Ranges = std::array<std::pair<std::size_t, std::size_t>, 9>;
    Ranges around(const Eigen::Vector3d& p) const;

    /** Is a point within `radius` of p? `radius` is at most a cell's size. */
    bool hasWithin(const Eigen::Vector3d& p, double radius) const;

 private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cellOf(const Eigen::Vector3d& p) const;
    static std::uint64_t keyOf(const Cell& cell);

    double size_;
    std::vector<Eigen::Vector3f> points_;
    std::vector<std::uint64_t> keys_;    //!< of the cells, increasing
    std::vector<std::uint32_t> begins_;  //!< of their points; one more than there are cells
};
}  // namespace taut
